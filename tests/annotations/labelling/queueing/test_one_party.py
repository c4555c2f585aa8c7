"""One person is one party: nobody settles alone what several people have to answer, by whatever door."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from threading import Barrier

import pytest
from django.db import connections

from annotations.labelling.audit_findings import doubt
from annotations.labelling.collecting import collect
from annotations.labelling.enqueuing import WantedItem, enqueue, refill, set_share
from annotations.labelling.finishing import skip
from annotations.labelling.giving import next_item, take
from annotations.labelling.item_answers import answer, take_answer_back
from annotations.labelling.label_answers import NoLongerYours, label, restore_utterance
from annotations.labelling.label_decisions import decide
from annotations.models import (
    Assignment,
    FindingStatus,
    Label,
    Utterance,
    Verdict,
    WorkItem,
    WorkKind,
    World,
)
from annotations.models.queueing import Outcome
from annotations.models.worlds import Role
from annotations.rows.history import history_of
from tests.annotations.labelling.queueing.conftest import BRING, GO, kinds, say
from tests.conftest import member


@pytest.fixture
def asked(world, queue, annotator) -> Assignment:
    """The part of anna in an item that two people do."""
    set_share(world, WorkKind.UNLABELLED, 100)
    return next_item(annotator, world)


def state(part: Assignment) -> tuple[str, str, bool]:
    """The status and the form of the utterance, and whether its item is open."""
    utterance = Utterance.objects.get(pk=part.item.utterance_id)
    return utterance.status, utterance.logical_form, WorkItem.objects.get(pk=part.item_id).is_open


def valid(part: Assignment) -> list[tuple[str, str, bool]]:
    """The answers that were not taken back: by whom, what, and whether it counts."""
    rows = Label.objects.valid().filter(utterance=part.item.utterance_id).order_by("pk")
    return [(str(row.annotator), row.form or row.verdict, bool(row.accepted_at)) for row in rows]


WAITS = ("unlabelled", "", True)


def test_the_same_answer_once_more_changes_nothing(asked):
    assert say(asked, BRING) == say(asked, BRING)
    assert state(asked) == WAITS
    assert valid(asked) == [("anna", BRING, False)]


def test_another_answer_replaces_the_first_while_the_second_person_is_asked(asked, berta, world):
    say(asked, BRING)
    say(asked, GO)
    say(asked, "", Verdict.UNKNOWN)
    assert state(asked) == WAITS
    assert valid(asked) == [("anna", "unknown", False)]
    assert say(next_item(berta, world), "", Verdict.UNKNOWN).accepted_at
    assert state(asked) == ("unknown", "", False)


def test_an_answer_that_becomes_a_skip_leaves_the_place_to_others(asked, berta, carl, world):
    say(asked, BRING)
    say(asked, "", Verdict.SKIP)
    assert state(asked) == WAITS
    for person in (berta, carl):
        say(next_item(person, world), GO)
    assert state(asked) == ("labelled", GO, False)


def test_who_has_skipped_it_is_one_of_the_two_when_they_answer_after_all(asked, berta, world):
    skip(asked)
    say(asked, BRING)
    assert state(asked) == WAITS
    assert say(next_item(berta, world), BRING).accepted_at


def test_others_wait_until_both_have_answered(asked, berta, carl, world):
    next_item(berta, world)
    with pytest.raises(NoLongerYours):
        answer(asked.item.utterance, Verdict.FORM, BRING, carl, 1)
    assert state(asked) == WAITS


def test_neither_of_two_settles_their_difference(asked, berta, carl, world):
    first = say(asked, BRING)
    say(next_item(berta, world), GO)
    assert kinds(world)[0] == WorkKind.ADJUDICATION
    for person, form in ((asked.person, GO), (berta, BRING)):
        with pytest.raises(NoLongerYours):
            answer(asked.item.utterance, Verdict.FORM, form, person, 1)
        with pytest.raises(NoLongerYours):
            label(asked.item.utterance, Verdict.FORM, form, person, 1)
    assert say(asked, BRING) == first
    assert state(asked) == ("unlabelled", "", False)
    assert answer(asked.item.utterance, Verdict.FORM, GO, carl, 1).accepted_at
    assert state(asked) == ("labelled", GO, False)


def test_nobody_settles_what_they_dispute(world, queue, annotator, berta):
    part = next_item(annotator, world)
    say(part, "", Verdict.DISPUTE, reason="two robots are meant")
    with pytest.raises(NoLongerYours):
        say(part, BRING)
    take_answer_back(Label.objects.get(verdict=Verdict.DISPUTE), annotator)
    assert say(part, BRING).accepted_at


@pytest.fixture
def looked_at_again(world, utterances, annotator, reviewer) -> Utterance:
    """A labelled utterance about which two people are asked once more."""
    answer(utterances[0], Verdict.FORM, BRING, annotator, 1)
    set_share(world, WorkKind.REQUESTED, 100)
    enqueue(world, WorkKind.REQUESTED, [WantedItem(utterances[0], "Is it so?")], reviewer)
    return Utterance.objects.get(pk=utterances[0].pk)


def test_no_version_is_restored_in_place_of_two_answers(looked_at_again, annotator, berta, world):
    say(
        next_item(
            berta,
            world,
        ),
        GO,
    )
    entry = history_of(Utterance).filter(id=looked_at_again.pk).order_by("version").first()
    for person in (annotator, berta):
        with pytest.raises(NoLongerYours):
            restore_utterance(entry, person)
    looked_at_again.refresh_from_db()
    assert (looked_at_again.logical_form, looked_at_again.version) == (BRING, 2)


def test_no_audit_is_decided_in_place_of_two_answers(looked_at_again, reviewer, berta, world):
    say(next_item(berta, world), GO)
    finding = doubt(looked_at_again, "It is the other room.", reviewer, GO)
    for person in (berta, reviewer):
        with pytest.raises(NoLongerYours):
            decide(finding, FindingStatus.CORRECTED, person)
    decide(finding, FindingStatus.KEPT, reviewer)
    looked_at_again.refresh_from_db()
    assert looked_at_again.logical_form == BRING


def test_who_takes_what_they_hold_keeps_it(world, queue, annotator):
    held = next_item(annotator, world)
    assert take(annotator, held.item).pk == held.pk
    assert WorkItem.objects.get(pk=held.item_id).places == 0


@pytest.mark.django_db(transaction=True)
@pytest.mark.parametrize("forms", [[BRING] * 4, [BRING, GO] * 2], ids=["the same", "others"])
def test_answers_of_one_person_at_once_are_one_answer(forms):
    world = World.objects.create(name="home")
    anna, berta = (member(world, name, Role.ANNOTATOR) for name in ("anna", "berta"))
    collect(world, ["bring me tea"], by=anna)
    set_share(world, WorkKind.UNLABELLED, 100)
    refill(world)
    part = next_item(anna, world)
    start = Barrier(len(forms))

    def post(form: str) -> None:
        try:
            start.wait()
            answer(part.item.utterance, Verdict.FORM, form, anna, 1, assignment=part)
        finally:
            connections.close_all()

    with ThreadPoolExecutor(len(forms)) as threads:
        list(threads.map(post, forms))
    assert state(part) == WAITS
    assert len(valid(part)) == 1
    assert Assignment.objects.get().outcome == Outcome.DONE
    say(next_item(berta, world), valid(part)[0][1])
    assert state(part)[0] == "labelled"
