"""The numbers of a world: exact while they are few, and kept for a while where a page would count for long."""

from __future__ import annotations

from dataclasses import fields, replace

import pytest
from django.db.models import F
from django.utils import timezone

from annotations.labelling.collecting import collect
from annotations.labelling.enqueuing import WantedItem, enqueue
from annotations.labelling.label_answers import label, take_back_label
from annotations.models import Job, Verdict, WorkItem, WorkKind, World
from annotations.models.background import Status
from annotations.rows import kept
from gpsr_site.overview import counts
from gpsr_site.overview.counts import LARGE, counts_of, counts_of_all
from tests.sample_world import paraphrase_in

GO = '( go " <room> " )'


@pytest.fixture(autouse=True)
def _nothing_kept():
    counts._kept.clear()
    yield
    counts._kept.clear()


@pytest.fixture
def large(sample, monkeypatch):
    """A world whose numbers are kept for as long as nothing of the clock or the jobs says otherwise."""
    monkeypatch.setattr(counts, "MOST_READ", 0)
    monkeypatch.setattr(kept, "SHARE", 1_000_000)
    monkeypatch.setattr(kept, "SHARE_AFTER_CHANGE", 0)
    collect(sample.world, ["would you find me the tea", "go to the kitchen"])
    counts_of(sample.world)
    return sample.world


def counted_afresh(world):
    counts._kept.clear()
    return replace(counts_of(world), age=0)


def test_small_worlds_are_counted_for_each_page(sample, annotator):
    """Whatever is written, the numbers are those of this moment."""
    world = sample.world
    writes = [
        lambda: collect(world, ["would you find me the tea", "go to the kitchen"]),
        lambda: label(world.utterances.first(), Verdict.FORM, GO, annotator, 1),
        lambda: take_back_label(world.utterances.first().labels.get(), annotator),
        lambda: enqueue(
            world, WorkKind.UNLABELLED, [WantedItem(row, "new") for row in world.utterances.all()]
        ),
        lambda: paraphrase_in(world),
        lambda: world.paraphrases.update(status="pending"),
        lambda: world.commands.all().delete(),
        lambda: world.logical_forms.all().delete(),
        lambda: world.work_items.all().delete(),
        lambda: world.utterances.all().delete(),
    ]
    for write in writes:
        before = replace(counts_of(world), age=0)
        write()
        after = replace(counts_of(world), age=0)
        assert after == counted_afresh(world)
        assert after != before


def test_large_numbers_are_kept_and_small_ones_are_not(large, django_assert_num_queries):
    before = counts_of(large)
    collect(large, ["bring me the tea"])
    large.splits.all().delete()
    with django_assert_num_queries(1):
        after = counts_of(large)
    assert after.utterances == before.utterances == 2
    assert (before.splits, after.splits) == (1, 0)
    assert after.age > before.age > 0


def test_kept_numbers_are_renewed_when_they_are_old(large, monkeypatch):
    collect(large, ["bring me the tea"])
    monkeypatch.setattr(kept, "MOST_SECONDS", 0)
    assert replace(counts_of(large), age=0) == counted_afresh(large)


def test_kept_numbers_are_renewed_after_jobs_and_generations(large):
    collect(large, ["bring me the tea"])
    job = Job.objects.create(world=large, world_name=large.name, kind="audit")
    assert counts_of(large).utterances == 2
    Job.objects.filter(pk=job.pk).update(status=Status.SUCCEEDED, finished_at=timezone.now())
    assert counts_of(large).utterances == 3
    collect(large, ["bring me the milk"])
    World.objects.filter(pk=large.pk).update(generations=F("generations") + 1)
    assert counts_of(large).utterances == 4


def test_nobody_is_told_of_work_where_there_is_none(large):
    """Free items are counted exactly while they are few, also where other numbers are kept."""
    items = large.work_items.free()
    enqueue(large, WorkKind.UNLABELLED, [WantedItem(row, "new") for row in large.utterances.all()])
    assert counts_of(large).work_items_free == items.count() > 0
    WorkItem.objects.update(places=0)
    assert counts_of(large).work_items_free == 0


def test_of_very_many_free_items_the_kept_number_is_told(large, monkeypatch):
    monkeypatch.setattr(counts, "MOST_EXACT", 1)
    waiting = [WantedItem(row, "new") for row in large.utterances.all()]
    enqueue(large, WorkKind.UNLABELLED, waiting)
    assert counts_of(large).work_items_free == 1  # at least
    counts._kept.clear()
    assert counts_of(large).work_items_free == large.work_items.free().count()


def test_while_one_thread_counts_others_take_what_is_kept(large, monkeypatch):
    collect(large, ["bring me the tea"])
    monkeypatch.setattr(kept, "MOST_SECONDS", 0)
    monkeypatch.setattr(counts, "_in_hand", {large.pk})
    assert counts_of(large).utterances == 2


def test_a_large_world_beside_small_ones_alone_is_kept(
    large, other_sample, monkeypatch, django_assert_num_queries
):
    monkeypatch.setattr(counts, "MOST_READ", 10_000)
    with django_assert_num_queries(2):
        assert counts_of_all(World.objects.all())[large.pk].utterances == 2
    assert set(counts._kept) == {large.pk}


def test_the_rail_says_how_old_a_number_is_once_that_is_minutes(large, annotator, client):
    client.force_login(annotator)

    def said():
        groups = client.get("/w/home/").context["rail"]
        return {link.label: link.counted for group in groups for link in group.links}

    assert not any(said().values())
    now = counts._kept[large.pk]
    counts._kept[large.pk] = replace(now, computed_at=now.computed_at - 200, seconds=1e6)
    told = said()
    assert "3" in told["Label"]
    assert not told["Splits"]


def test_every_number_is_counted_once(sample):
    names = {each.name for each in fields(counts.Counts)}
    assert set(LARGE) < names
    assert counts_of(sample.world).age >= 0
