"""Utterances are deleted and restored with their answers and with what people are asked about them."""

from __future__ import annotations

import pytest
from django.core.exceptions import ValidationError

from annotations.editing.edits import Overtaken
from annotations.exchange.world_deletion import count_below, delete_world
from annotations.labelling.collecting import collect
from annotations.labelling.enqueuing import set_share
from annotations.labelling.giving import next_item
from annotations.labelling.item_answers import answer
from annotations.labelling.label_answers import AnsweredMeanwhile, label
from annotations.labelling.utterance_deletion import (
    delete_utterance,
    delete_utterances,
    restore,
    restore_utterances,
)
from annotations.models import Label, Utterance, Verdict, WorkItem, WorkKind
from annotations.rows.row_kinds import KINDS

GO = '( go " <room> " )'


@pytest.fixture
def row(tiny_world, annotator) -> Utterance:
    collect(tiny_world, ["go to the kitchen", "find the tea"], by=annotator)
    return tiny_world.utterances.first()


def deletion_of(row):
    return KINDS["utterance"].deletions_in(row.world).get(id=row.pk)


def test_a_deleted_utterance_is_nowhere_and_comes_back_with_its_answers(row, annotator, reviewer):
    world = row.world
    answer(row, Verdict.FORM, GO, annotator, 1)
    row.refresh_from_db()
    delete_utterance(row, annotator, row.version)
    assert row not in world.utterances.all()
    assert not Label.objects.of_world(world).exists()
    assert not world.utterances.labelled().exists()
    restored = restore(deletion_of(row), reviewer)
    assert (restored.status, restored.logical_form, restored.version) == ("labelled", GO, 3)
    assert Label.objects.of_world(world).get().annotator == annotator


def test_its_items_are_closed_and_opened_again_with_the_answers_given(
    row, annotator, reviewer, admin
):
    world = row.world
    set_share(world, WorkKind.UNLABELLED, 100)
    item = next_item(annotator, world).item
    answer(item.utterance, Verdict.FORM, GO, annotator, 1)
    delete_utterances([item.utterance_id], admin)
    assert not WorkItem.objects.open().filter(utterance=item.utterance_id).exists()
    assert not world.work_items.present().filter(utterance=item.utterance_id).exists()
    restore(deletion_of(item.utterance), admin)
    item.refresh_from_db()
    assert (item.closed_at, item.places) == (None, 1)


def test_who_saw_another_version_deletes_nothing(row, annotator):
    label(row, Verdict.UNKNOWN, "", annotator, 1)
    with pytest.raises(Overtaken):
        delete_utterance(row, annotator, 1)
    row.refresh_from_db()
    delete_utterance(row, annotator, 2)
    with pytest.raises(Overtaken):
        delete_utterance(row, annotator, 2)


def test_an_answer_to_one_that_is_deleted_meanwhile_is_refused(row, annotator):
    delete_utterances([row.pk], annotator)
    with pytest.raises(AnsweredMeanwhile):
        label(row, Verdict.UNKNOWN, "", annotator, 1)
    assert not Label.objects.exists()


def test_its_text_may_be_added_again_and_is_not_restored_beside_itself(row, annotator):
    delete_utterances([row.pk], annotator)
    assert collect(row.world, [row.text], by=annotator).added == 1
    with pytest.raises(ValidationError):
        restore(deletion_of(row), annotator)


def test_of_deleted_utterances_with_one_text_the_newest_comes_back(row, annotator):
    world, text = row.world, row.text
    for _ in range(3):
        delete_utterances([world.utterances.get(text=text).pk], annotator)
        collect(world, [text])
    last = world.utterances.get(text=text)
    delete_utterances([last.pk], annotator)
    assert restore_utterances(Utterance.with_deleted.filter(text=text), annotator) == (1, 3)
    assert world.utterances.get(text=text) == last


def test_deleted_utterances_count_among_what_goes_with_a_world(row, annotator):
    delete_utterances([row.pk], annotator)
    assert count_below(row.world)[Utterance] == 2


def test_a_world_goes_with_its_deleted_utterances(row, annotator):
    delete_utterances([row.pk], annotator)
    delete_world(row.world)
    assert not Utterance.with_deleted.exists()
