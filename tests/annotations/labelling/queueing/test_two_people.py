"""Two people label one utterance without seeing each other; a third settles what differs."""

from __future__ import annotations

import pytest

from annotations.labelling.enqueuing import set_share
from annotations.labelling.giving import NotForThem, assign, next_item
from annotations.labelling.item_answers import take_answer_back
from annotations.labelling.label_answers import NoLongerYours
from annotations.models import Utterance, Verdict, WorkItem, WorkKind
from tests.annotations.labelling.queueing.conftest import BRING, GO, kinds, say


@pytest.fixture
def both(world, queue, annotator, berta):
    """The parts of two people in the first item, which two people do."""
    set_share(world, WorkKind.UNLABELLED, 100)
    parts = [next_item(annotator, world), next_item(berta, world)]
    assert parts[0].item == parts[1].item
    return parts


def test_nobody_but_two_people_gets_it(world, both, carl):
    assert next_item(carl, world).item != both[0].item


def state_of(assignment):
    utterance = Utterance.objects.get(pk=assignment.item.utterance_id)
    return utterance.status, utterance.logical_form


def test_the_first_answer_decides_nothing(both):
    say(both[0])
    assert WorkItem.objects.get(pk=both[0].item_id).is_open
    assert state_of(both[0]) == ("unlabelled", "")


def test_what_both_say_counts_until_one_takes_it_back(both, berta):
    say(both[0], BRING)
    label = say(both[1], BRING)
    assert not WorkItem.objects.get(pk=both[0].item_id).is_open
    assert state_of(both[0]) == ("labelled", BRING)
    take_answer_back(label, berta)
    assert state_of(both[0]) == ("unlabelled", "")


def test_the_order_of_conjuncts_is_no_difference(both):
    say(both[0], "( find ( lambda $1 e ( red $1 ) ( big $1 ) ) )")
    say(both[1], "( find ( lambda $1 e ( big $1 ) ( red $1 ) ) )")
    assert state_of(both[0])[0] == "labelled"


def test_a_third_person_settles_a_difference(world, both, annotator, berta, carl, admin):
    say(both[0], BRING)
    say(both[1], GO)
    follow_up = both[1].item.followed_by
    assert follow_up.kind == WorkKind.ADJUDICATION
    assert "anna" in follow_up.reason and "berta" in follow_up.reason
    for person in (annotator, berta):
        assert next_item(person, world).item != follow_up
        with pytest.raises(NotForThem) as refused:
            assign(follow_up, person, by=admin)
        assert refused.value.code == "already_answered"
    assert state_of(both[0]) == ("unlabelled", "")
    settling = next_item(carl, world)
    assert settling.item == follow_up
    say(settling, GO)
    assert state_of(both[0]) == ("labelled", GO)


def test_a_reviewer_may_settle(world, both, reviewer):
    say(both[0], BRING)
    say(both[1], BRING, Verdict.UNKNOWN)
    assert next_item(reviewer, world).item.kind == WorkKind.ADJUDICATION


def test_an_answer_is_taken_back_until_somebody_compares_it(world, both, annotator, berta, carl):
    first, label = say(both[0], BRING), say(both[1], GO)
    take_answer_back(label, berta)
    assert WorkKind.ADJUDICATION not in kinds(world)
    say(next_item(berta, world), GO)
    assert next_item(carl, world).item.kind == WorkKind.ADJUDICATION
    with pytest.raises(NoLongerYours) as refused:
        take_answer_back(first, annotator)
    assert refused.value.code == "gone_on_from"


def test_what_is_disputed_goes_to_somebody_else(world, queue, annotator, berta):
    held = next_item(annotator, world)
    say(held, "", Verdict.DISPUTE, reason="two robots are meant")
    follow_up = held.item.followed_by
    assert "anna" in follow_up.reason and follow_up.reason.endswith(" two robots are meant")
    assert next_item(annotator, world).item != follow_up
    assert next_item(berta, world).item == follow_up
