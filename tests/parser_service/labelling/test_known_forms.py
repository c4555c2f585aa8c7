"""Neighbours follow every write, at the cost of what was written, for as many worlds as memory holds."""

from __future__ import annotations

import pytest
from django.db import connection
from django.test.utils import CaptureQueriesContext

from annotations.labelling.collecting import collect
from annotations.labelling.label_answers import label, take_back_label
from annotations.labelling.utterance_deletion import delete_utterances
from annotations.models import Utterance, Verdict, World
from parser_service.labelling import known_forms
from parser_service.labelling.known_forms import nearest_forms
from tests.sample_world import paraphrase_in

HOOVER, SWEEP = "( hoover )", "( sweep )"


@pytest.fixture
def labelled(sample, annotator):
    collect(sample.world, ["hoover up", "hoover down", "sweep there"])
    for row, form in zip(
        sample.world.utterances.order_by("pk"), (HOOVER, HOOVER, SWEEP), strict=True
    ):
        label(row, Verdict.FORM, form, annotator, row.version)
    return sample.world


def neighbours(world, text="hoover here"):
    """What is answered, which is what an index that is made anew answers."""
    world = World.objects.get(pk=world.pk)
    kept = nearest_forms(world, text, 9)
    known_forms._kept.clear()
    assert kept == nearest_forms(world, text, 9)
    return [each.form for each in kept]


def test_neighbours_follow_every_kind_of_write(labelled, annotator):
    assert neighbours(labelled) == [HOOVER]
    first, second, _ = labelled.utterances.order_by("pk")
    take_back_label(first.labels.get(), annotator)
    take_back_label(second.labels.get(), annotator)
    assert neighbours(labelled) == []
    first.refresh_from_db()
    label(first, Verdict.FORM, SWEEP, annotator, first.version)
    assert neighbours(labelled) == [SWEEP]
    delete_utterances([first.pk], annotator)
    assert neighbours(labelled) == []
    said = paraphrase_in(labelled)
    said.utterance, said.logical_form, said.version = "hoover now", HOOVER, said.version + 1
    said.save()
    assert neighbours(labelled) == [HOOVER]
    labelled.paraphrases.update(status="rejected")
    assert neighbours(labelled) == []


def test_an_answer_costs_what_it_changes(labelled, annotator):
    nearest_forms(labelled, "hoover here", 9)
    with CaptureQueriesContext(connection) as unchanged:
        nearest_forms(labelled, "hoover here", 9)
    assert len(unchanged) == 2
    row = labelled.utterances.first()
    take_back_label(row.labels.get(), annotator)
    kept = known_forms._kept["labelled", labelled.pk]
    pairs = kept.pairs
    nearest_forms(labelled, "hoover here", 9)
    assert known_forms._kept["labelled", labelled.pk].pairs is pairs
    assert len(pairs) == 3 and len(pairs.versions) == 2


def test_only_the_newest_are_neighbours(labelled, monkeypatch):
    monkeypatch.setattr(known_forms, "MOST_LABELLED", 1)
    assert neighbours(labelled, "hoover sweep") == [SWEEP]


def test_memory_bounds_what_is_kept_and_not_a_number_of_worlds(labelled, monkeypatch):
    others = [World.objects.create(name=f"other-{number}") for number in range(6)]
    for world in others:
        Utterance.objects.create(
            world=world,
            text="hoover",
            anonymized_text="hoover",
            status="labelled",
            logical_form=HOOVER,
        )
        nearest_forms(world, "hoover", 9)
    nearest_forms(labelled, "hoover", 9)
    assert {world for _, world in known_forms._kept} == {labelled.pk, *(each.pk for each in others)}
    monkeypatch.setattr(known_forms, "MOST_KEPT", 0)
    nearest_forms(labelled, "hoover", 9)
    assert {world for _, world in known_forms._kept} == {labelled.pk}
