"""What the overview says waits: the numbers agree with the pages, and each role reads its own first."""

from __future__ import annotations

import re

import pytest

from annotations.labelling.collecting import collect
from annotations.labelling.enqueuing import refill
from annotations.labelling.giving import next_item
from annotations.language.corpus import Criterion
from annotations.language.grammar import Grammar
from annotations.models import (
    Job,
    Split,
    StoredProblem,
    TaskCategory,
    World,
)
from annotations.models.worlds import DUTIES, Role
from gpsr_site.overview.best_runs import best_runs
from gpsr_site.overview.counts import counts_of
from gpsr_site.overview.work_list import WorkList
from gpsr_site.overview.workers import Workers, workers_now
from parser_service.models import Evaluation, TrainingRun
from parser_service.models.runs import Status
from parser_service.runs import run_requests
from tests.parser_service.made_up import make_split
from tests.sample_world import make_paraphrase, scored_run

NO_WORKER = Workers(served=set(), running=0, waiting={"cpu": 1}, noun="run")


@pytest.fixture
def busy(sample):
    """The sample world with something of every kind that can wait, in different numbers."""
    for subject, count in (("ontology", 2), ("grammar", 3), ("commands", 5)):
        StoredProblem.objects.bulk_create(
            StoredProblem(world=sample.world, subject=subject, severity="warning", message="m")
            for _ in range(count)
        )
    template = sample.template
    for position, status in enumerate(("draft", "draft", "disputed"), start=10):
        template.pk, template.position, template.status = None, position, status
        template.problems = [{"severity": "warning", "message": "m"}]
        template.save()
    make_paraphrase(
        sample.world,
        prompt="go to the kitchen",
        utterance="kitchen please",
        status="pending",
    )
    for seed, status in enumerate(
        (Status.FAILED, Status.FAILED, Status.LOST, Status.QUEUED, Status.RUNNING), start=1
    ):
        run, _ = run_requests.request(sample.world, sample.split, "knn", seed=seed, send=False)
        TrainingRun.objects.filter(pk=run.pk).update(status=status)
    TaskCategory.objects.update(commands_in_grammar=3, commands_with_form=1)
    sample.world.commands.last().delete()
    sample.world.commands.last().delete()
    sample.world.mark_changed()
    score_both_sources()
    return sample


def score_both_sources() -> None:
    """The scores of the sample world count commands and paraphrases together."""
    Evaluation.objects.update(test_source="mixed")


def work_of(world: World, role: Role, workers: Workers = NO_WORKER) -> WorkList:
    world.refresh_from_db()
    return WorkList(world, counts_of(world), DUTIES[role], workers, best_runs(world))


def rows_behind(client, url: str) -> int:
    """How many rows the page of ``url`` lists."""
    context = client.get(url).context
    if url.endswith("/people/"):
        return len(context["members"])
    return (
        context["listing"].total
        if "?" in url or url.endswith("/coverage/")
        else len(context["problems"])
    )


def test_each_count_is_the_number_of_rows_behind_its_link(busy, adam):
    items = [item for item in work_of(busy.world, Role.ADMIN).items if not item.is_action]
    counts = {item.sentence: item.count for item in items}
    assert {item.sentence: rows_behind(adam, item.url) for item in items} == counts
    assert counts == {
        "1 run waits. No worker is running.": 1,
        "2 failed runs": 2,
        "1 lost run": 1,
        "2 warnings on the ontology": 2,
        "3 warnings on the grammar": 3,
        "1 run in progress": 1,
        "Only one person belongs to this world": 1,
        "2 commands without a form": 2,
        "3 templates with problems": 3,
        "5 warnings on commands": 5,
        "2 draft templates": 2,
        "1 disputed template": 1,
        "1 paraphrase to judge": 1,
    }


def test_an_utterance_counts_once_as_an_item_or_as_one_without_a_form(sample, anna, annotator):
    collect(sample.world, ["find the tea now", "find the tea please"], by=annotator)
    texts = [each.sentence for each in work_of(sample.world, Role.ANNOTATOR).items]
    assert "2 utterances without a form, not waiting in the queue" in texts
    refill(sample.world)
    items = work_of(sample.world, Role.ANNOTATOR).items
    (waiting,) = (each for each in items if "in the work queue" in each.sentence)
    assert waiting.count == 2 and not any("without a form, not" in each.sentence for each in items)
    held = next_item(annotator, sample.world)
    counts = counts_of(World.objects.get(pk=sample.world.pk))
    assert (counts.work_items_free, counts.utterances_waiting) == (1, 1)
    # One press leads from the overview to the first utterance.
    assert f'action="{waiting.url}"' in anna.get("/w/home/").content.decode()
    first = f"/w/home/label/?utterance={held.item.utterance_id}"
    assert anna.post(waiting.url)["Location"] == first


def success_like(run: TrainingRun, split: Split) -> None:
    run.pk, run.split, run.status, run.content_key = None, split, "succeeded", "another"
    run.save()


def sentences_of_failed(world: World) -> list[str]:
    items = work_of(world, Role.ADMIN).items
    return [item.sentence for item in items if "failed" in item.sentence]


def test_failed_runs_wait_until_a_later_one_succeeds(busy, adam):
    run = TrainingRun.objects.filter(status="failed").first()
    success_like(run, busy.split)
    assert sentences_of_failed(busy.world) == []
    assert rows_behind(adam, "/w/home/runs/?status=failed&since=no") == 0
    assert rows_behind(adam, "/w/home/runs/?status=failed&since=yes") == 2


def test_a_success_on_another_split_makes_up_for_nothing(busy):
    run = TrainingRun.objects.filter(status="failed").first()
    values = {"world": busy.world, "criterion": "command", "content_hash": "other"}
    success_like(run, Split.objects.create(name="other", **values))
    assert sentences_of_failed(busy.world) == ["2 failed runs"]


def test_a_reviewer_is_led_to_as_many_wrong_answers_as_are_said(busy, rene):
    item = work_of(busy.world, Role.REVIEWER).items[0]
    assert item.sentence.startswith("9 ") and "Nearest neighbour" in item.sentence
    assert rows_behind(rene, item.url) == item.count == 9


@pytest.mark.parametrize(
    ("role", "first", "count", "others"),
    [
        (Role.ADMIN, "/w/home/generate/", 1, [Role.ANNOTATOR, Role.REVIEWER]),
        (Role.ANNOTATOR, "/w/home/coverage/", 2, [Role.ADMIN, Role.REVIEWER]),
        (Role.REVIEWER, "/w/home/review/", 9, [Role.ADMIN, Role.ANNOTATOR]),
    ],
)
def test_each_role_reads_its_own_work_first(role, first, count, others, busy):
    own, *rest = work_of(busy.world, role).groups
    assert (own.role, own.is_own, own.items[0].count) == (role, True, count)
    assert own.items[0].url.startswith(first)
    assert [(group.role, group.is_own) for group in rest] == [(each, False) for each in others]


def test_an_item_stands_once_and_a_reviewer_gets_no_button_that_refuses(busy):
    for role in Role:
        items = work_of(busy.world, role).items
        assert len(items) == len(set(items))
    actions = [item for item in work_of(busy.world, Role.REVIEWER).items if item.is_action]
    assert actions == []


def test_jobs_stand_with_whom_they_wait_for(sample, admin, adam, anna):
    common = {"world": sample.world, "world_name": sample.world.name, "created_by": admin}
    asking = Job.objects.create(
        **common, kind="import_generator", status="succeeded", report={"is_waiting": True}
    )
    Job.objects.create(**common, kind="import_pairs", status="succeeded", report={})
    running = Job.objects.create(**common, kind="generate", status="running")
    assert list(sample.world.jobs.needing_attention()) == [running, asking]
    own, *_ = adam.get("/w/home/").context["work_groups"]
    assert own.items[0].url == f"/jobs/{asking.pk}/"
    assert own.items[0].sentence.startswith(asking.title)
    own, *_ = anna.get("/w/home/").context["work_groups"]
    assert own.items[0].url == f"/jobs/{running.pk}/"
    assert running.title in own.items[0].sentence and "running" in own.items[0].sentence
    assert anna.get(own.items[0].url).status_code == 200


def test_commands_are_out_of_date_until_they_are_generated(busy, anna):
    generate = 'action="/w/home/generate/"'
    assert generate in anna.get("/w/home/").content.decode()
    anna.post("/w/home/generate/")
    assert generate not in anna.get("/w/home/").content.decode()


def test_the_overview_shows_coverage_and_expands_nothing(busy, anna, monkeypatch):
    def refuse(self, *args, **kwargs):
        raise AssertionError("a page expanded the grammar")

    monkeypatch.setattr(Grammar, "commands", refuse)
    page = anna.get("/w/home/").content.decode()
    assert "33.3 %" in page
    assert re.search(r'href="/w/home/coverage/[^"]*"[^>]*>\s*2 ', page)


def test_a_share_that_is_not_all_never_reads_as_all(sample, anna):
    TaskCategory.objects.update(commands_in_grammar=50_000, commands_with_form=49_999)
    assert "100.0 %" not in anna.get("/w/home/").content.decode()


def test_the_best_run_of_each_protocol_leads_to_its_wrong_answers(sample, anna):
    scored_run(sample.world, sample.split, "seq2seq", right=5)
    score_both_sources()
    best = best_runs(sample.world)
    (run,) = best.runs
    assert (run.title, run.wrong) == ("Sequence to sequence", 7)
    assert run.wrong_url.replace("&", "&amp;") in anna.get("/w/home/").content.decode()
    assert anna.get(run.wrong_url).context["listing"].total == 7


def test_the_best_run_is_of_a_split_by_command_where_there_is_one(sample):
    by_form = make_split(sample.world, "by-form")
    Split.objects.filter(pk=by_form.pk).update(criterion=Criterion.LOGICAL_FORM)
    scored_run(sample.world, by_form, "seq2seq", right=1)
    assert best_runs(sample.world).split == sample.split
    sample.split.runs.all().delete()
    assert best_runs(sample.world).split == by_form


def test_a_world_without_scores_has_no_best_run(world):
    assert best_runs(world) is None


def test_only_who_may_add_people_is_told_that_somebody_is_alone(sample, admin, annotator):
    sample.world.memberships.exclude(user=annotator).delete()
    counts = counts_of(sample.world)
    for role, is_told in ((Role.ADMIN, True), (Role.ANNOTATOR, False), (Role.REVIEWER, False)):
        work = WorkList(sample.world, counts, DUTIES[role], workers_now())
        assert any(item.url == "/w/home/people/" for item in work.items) is is_told


def test_an_administrator_whose_only_world_came_with_the_project_is_led_to_an_own_one(
    world, admin, superuser, client
):
    World.objects.filter(pk=world.pk).update(name="household")
    for user, is_told in ((admin, False), (superuser, True)):
        client.force_login(user)
        page = client.get("/w/household/").content.decode().partition("<main")[2]
        assert ("Your own files need a world of their own" in page) is is_told
        assert ('href="/worlds/new/"' in page) is is_told
    World.objects.create(name="ours")
    page = client.get("/w/household/").content.decode().partition("<main")[2]
    assert 'href="/worlds/new/"' not in page


def test_the_list_of_worlds_says_what_waits_in_each(busy, other_world, adam):
    page = adam.get("/")
    ((world, _, items),) = page.context["listed"]
    assert world == busy.world and "/w/home/generate/" in [each.url for each in items]
    assert all(each.sentence in page.content.decode() for each in items)
    assert "laboratory" not in page.content.decode()


def test_the_overview_costs_no_query_a_run_or_category(busy, adam, django_assert_max_num_queries):
    for seed in range(20, 30):
        scored_run(busy.world, busy.split, seed=seed)
    with django_assert_max_num_queries(23):
        adam.get("/w/home/")
