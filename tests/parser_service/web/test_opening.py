"""What a page opens on where its address names no run: what answers in the world, else the best run."""

from __future__ import annotations

import pytest
from django.utils import timezone

from annotations.generation.split_statistics import store_figures
from annotations.models import Split
from gpsr_site.overview.best_runs import best_runs
from parser_service.models import Evaluation, TrainingRun, Worker
from parser_service.models.runs import Status
from parser_service.parsers.conditions import in_words
from parser_service.runs.promoting import promote
from parser_service.serving.default_runs import best_two, opening_run
from tests.parser_service.made_up import make_split
from tests.parser_service.served import score
from tests.sample_world import scored_run


@pytest.fixture
def by_form(sample):
    """The newest run, on a split of its own by form, right on nothing new."""
    split = make_split(sample.world, "by-form")
    Split.objects.filter(pk=split.pk).update(criterion="logical_form")
    return scored_run(sample.world, Split.objects.get(pk=split.pk), right=0)


@pytest.fixture
def better(sample):
    """A run on the sample split that is more often right on paraphrases than the sample run."""
    run = scored_run(sample.world, sample.split, seed=1, right=8)
    for each, accuracy in ((sample.run, 0.4), (run, 0.8)):
        Evaluation.objects.filter(run=each, part="validation", test_source="para").delete()
        score(each, accuracy)
    return run


def test_the_best_run_on_paraphrases_opens_not_the_newest(better, by_form, sample):
    assert opening_run(sample.world) == better
    promote(sample.run, None)
    assert opening_run(sample.world) == sample.run


def test_a_world_without_runs_opens_on_none(world):
    assert opening_run(world) is None


def test_review_opens_on_it(better, by_form, anna, sample):
    assert anna.get("/w/home/review/", follow=True).context["runs"] == [better]
    promote(sample.run, None)
    assert anna.get("/w/home/review/", follow=True).context["runs"] == [sample.run]


def test_the_overview_names_it(better, by_form, sample):
    best = best_runs(sample.world)
    assert (best.split, best.source) == (sample.split, in_words("para"))
    assert [each.score.run for each in best.runs] == [better]


def test_surer_is_better_than_more_often_right(better, sample):
    Evaluation.objects.filter(run=better).update(interval_low=0.2, accuracy=0.9)
    assert opening_run(sample.world) == sample.run
    assert best_runs(sample.world).runs[0].score.run == sample.run
    assert best_two(sample.split, [better, sample.run]) == [sample.run, better]


def test_a_run_that_asks_a_server_is_shown_but_not_asked(better, sample):
    TrainingRun.objects.filter(pk=better.pk).update(parser="llm")
    assert opening_run(sample.world) == sample.run
    assert best_runs(sample.world).runs[0].score.run == better


def test_parse_opens_on_it(better, by_form, anna, sample):
    promote(sample.run, None)
    page = anna.get("/w/home/parse/")
    assert page.context["chosen"] == ""


def test_the_try_out_opens_on_it(better, by_form, anna):
    assert anna.get("/w/home/parse/?beside=usual").context["chosen_beside"] == [better]


def test_compare_opens_on_the_split_with_runs_to_compare(better, by_form, anna, sample):
    page = anna.get("/w/home/compare/", {"part": "validation"}, follow=True)
    assert page.context["choice"].split == sample.split
    assert page.context["choice"].runs == (better, sample.run)
    assert page.context["pairs"]
    named = anna.get("/w/home/compare/", {"part": "validation", "split": "by-form"})
    assert named.context["choice"].split == by_form.split


def test_of_several_splits_compare_opens_on_that_with_most_runs(better, by_form, anna, sample):
    def opened():
        page = anna.get("/w/home/compare/", {"part": "validation"}, follow=True)
        return page.context["choice"].split

    scored_run(sample.world, by_form.split, seed=1, right=0)
    assert opened() == sample.split  # of two with as many that of the best run
    scored_run(sample.world, by_form.split, seed=2, right=0)
    assert opened() == by_form.split


def test_compare_opens_on_the_two_best_of_the_split(better, anna, sample):
    worst = scored_run(sample.world, sample.split, seed=2, right=1)
    Evaluation.objects.filter(run=worst).exclude(test_source="para").delete()
    page = anna.get("/w/home/compare/?part=validation&outcome=wrong", follow=True)
    assert page.redirect_chain == [
        (f"/w/home/compare/?part=validation&outcome=wrong&run={better.pk}&run={sample.run.pk}", 302)
    ]
    ticked = [each.run for each in page.context["choice"].offered if each.is_chosen]
    assert ticked == [better, sample.run]


def test_a_new_run_is_of_the_parser_that_is_recommended_next(sample, adam):
    """The split asks for forms that training does not have. Where it asks for one that training has often, and the
    nearest neighbour has a run, the next two follow."""
    assert adam.get("/w/home/runs/new/").context["chosen"] == "ranker"
    sample.split.examples.update(logical_form=sample.example.logical_form)
    store_figures(sample.split)
    asked = []
    for name in ("linear", "ranker", "ranker"):
        page = adam.get("/w/home/runs/new/")
        asked.append(page.context["chosen"])
        assert page.context["picker"].recommended.name == page.context["chosen"]
        assert "recommended" in page.content.decode()
        run = scored_run(sample.world, sample.split, parser="knn", seed=10 + len(asked))
        TrainingRun.objects.filter(pk=run.pk).update(parser=name)
    assert asked == ["linear", "ranker", "ranker"]
    TrainingRun.objects.filter(parser="linear").update(status=Status.FAILED)
    assert adam.get("/w/home/runs/new/").context["chosen"] == "linear"


def test_a_new_run_learns_from_paraphrases_too_where_there_are_any(sample, adam):
    def initial(**query):
        return adam.get("/w/home/runs/new/", query).context["form"]["train_sources"].value()

    assert initial() == "gen+para"
    assert initial(train_sources="para") == "para"
    sample.split.examples.filter(source="paraphrased").delete()
    store_figures(sample.split)
    assert initial() == "gen"


def test_a_new_run_is_on_a_split_with_paraphrases_by_command_first(sample, adam):
    def opened():
        page = adam.get("/w/home/runs/new/")
        split = page.context["form"]["split"].value()
        assert page.context["picker"].contents.split.pk == split
        return split

    def newer(name, criterion):
        Split.objects.filter(pk=(made := make_split(sample.world, name)).pk).update(
            criterion=criterion
        )
        return made

    newer("by-form", "logical_form")
    newer("by-source", "source_command")
    assert opened() == sample.split.pk
    newest = newer("again", "command")
    assert opened() == newest.pk
    newest.examples.filter(source="paraphrased").delete()
    store_figures(newest)
    assert opened() == sample.split.pk
    assert adam.get("/w/home/runs/new/", {"split": newest.pk}).context["form"][
        "split"
    ].value() == str(newest.pk)


@pytest.mark.parametrize(("served", "is_missed"), [("cpu", False), ("gpu", True)])
def test_an_analysis_waits_for_a_worker_of_its_own_queue(sample, rene, served, is_missed):
    TrainingRun.objects.update(queue="cpu")
    Worker.objects.create(name="w", host="h", process_id=1, queue=served, last_seen=timezone.now())
    rene.post(f"/w/home/runs/{sample.run.pk}/analysis/start/")
    page = rene.get(f"/w/home/runs/{sample.run.pk}/analysis/").content.decode()
    assert ("data-no-worker" in page) is is_missed
    assert "quick worker" not in page
