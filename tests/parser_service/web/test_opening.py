"""What a page opens on where its address names no run: what answers in the world, else the best run."""

from __future__ import annotations

import pytest
from django.utils import timezone

from annotations.models import Split
from parser_service.models import Evaluation, TrainingRun, Worker
from parser_service.models.runs import Status
from parser_service.promotions.promoting import promote
from parser_service.serving.default_runs import opening_run
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
    assert anna.get("/w/home/review/").context["runs"] == [better]
    promote(sample.run, None)
    assert anna.get("/w/home/review/").context["runs"] == [sample.run]


def test_parse_opens_on_it(better, by_form, anna, sample):
    assert anna.get("/w/home/parse/").context["chosen"] == better.pk
    promote(sample.run, None)
    page = anna.get("/w/home/parse/")
    assert (page.context["promoted"], page.context["chosen"]) == (sample.run, 0)


def test_the_try_out_opens_on_it(better, by_form, anna):
    assert anna.get("/w/home/try/").context["chosen"] == [better]


def test_compare_opens_on_the_split_with_runs_to_compare(better, by_form, anna, sample):
    page = anna.get("/w/home/compare/", {"part": "validation"})
    assert page.context["choice"].split == sample.split
    assert len(page.context["choice"].suggested or page.context["choice"].offered) == 2
    named = anna.get("/w/home/compare/", {"part": "validation", "split": "by-form"})
    assert named.context["choice"].split == by_form.split


def test_of_several_splits_compare_opens_on_that_of_the_opening_run(better, by_form, anna, sample):
    for seed in (1, 2):
        scored_run(sample.world, by_form.split, seed=seed, right=0)
    page = anna.get("/w/home/compare/", {"part": "validation"})
    assert page.context["choice"].split == sample.split


def test_a_new_run_is_of_the_parser_that_is_recommended_next(sample, adam):
    """Few pairs: the nearest neighbour has a run here, so the next two follow."""
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
    assert initial() == "gen"


@pytest.mark.parametrize(("served", "is_missed"), [("cpu", False), ("gpu", True)])
def test_an_analysis_waits_for_a_worker_of_its_own_queue(sample, rene, served, is_missed):
    TrainingRun.objects.update(queue="cpu")
    Worker.objects.create(name="w", host="h", process_id=1, queue=served, last_seen=timezone.now())
    rene.post(f"/w/home/runs/{sample.run.pk}/analysis/start/")
    page = rene.get(f"/w/home/runs/{sample.run.pk}/analysis/").content.decode()
    assert ("data-no-worker" in page) is is_missed
    assert "quick worker" not in page
