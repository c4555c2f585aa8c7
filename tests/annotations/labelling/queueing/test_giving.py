"""Who gets what: one place of an item to one person, most urgent first, back after the lease."""

from __future__ import annotations

import random
from datetime import timedelta

import pytest
from django.db.models import Count, Q
from django.utils import timezone

from annotations.labelling.enqueuing import WantedItem, enqueue, refill, set_share
from annotations.labelling.finishing import finish, give_back, skip
from annotations.labelling.giving import (
    ItemFilter,
    NotForThem,
    assign,
    close_item,
    next_item,
    take,
    withdraw,
)
from annotations.labelling.item_answers import answer, take_answer_back
from annotations.labelling.label_answers import NoLongerYours, label
from annotations.language.texts.errors import Refusal
from annotations.models import Assignment, Label, Verdict, WorkItem, WorkKind
from annotations.models.queueing import Outcome
from tests.annotations.labelling.queueing.conftest import kinds, say


def expire(assignment: Assignment) -> None:
    past = timezone.now() - timedelta(seconds=1)
    Assignment.objects.filter(pk=assignment.pk).update(leased_until=past)


def test_an_item_is_enqueued_once_while_it_is_open(world, queue, annotator):
    assert refill(world) == 0
    say(next_item(annotator, world))
    assert refill(world) == 0
    assert queue.count() == 2


def test_the_most_urgent_item_comes_first_then_the_oldest(world, queue, utterances, annotator):
    assert next_item(annotator, world).item.utterance == utterances[0]
    asked = WantedItem(utterances[2], "Rene asks what this means.")
    assert enqueue(world, WorkKind.REQUESTED, [asked]) == 1
    assert enqueue(world, WorkKind.REQUESTED, [asked]) == 0
    give_back(next_item(annotator, world))
    assert next_item(annotator, world).item.kind == WorkKind.REQUESTED


def test_nobody_is_asked_twice_about_one_utterance(world, queue, utterances, annotator):
    held = next_item(annotator, world)
    wanted = [WantedItem(row, "The parsers disagree.") for row in utterances]
    assert enqueue(world, WorkKind.DISAGREEMENT, wanted) == 2
    assert enqueue(world, WorkKind.LOW_CONFIDENCE, wanted) == 0
    assert queue.get(utterance=utterances[0]) == held.item
    assert kinds(world) == ["disagreement", "disagreement", "unlabelled"]


def test_one_keeps_what_one_holds(world, queue, annotator):
    first = next_item(annotator, world)
    expire(first)
    again = next_item(annotator, world)
    assert again.item_id == next_item(annotator, world).item_id
    assert again.leased_until > timezone.now()


def test_two_people_never_hold_one_item(world, queue, annotator, berta, carl, admin):
    held = [next_item(person, world) for person in (annotator, berta, carl)]
    assert len({each.item_id for each in held}) == 3
    assert next_item(admin, world) is None


def test_an_empty_queue_is_filled_from_the_rows(world, utterances, annotator):
    assert next_item(annotator, world).item.kind == WorkKind.UNLABELLED


def test_an_expired_lease_returns_to_the_queue(world, queue, annotator, berta):
    lost = next_item(annotator, world)
    expire(lost)
    assert next_item(berta, world).item_id == lost.item_id
    with pytest.raises(NoLongerYours) as refused:
        finish(lost)
    assert refused.value.code == "done_by_another"


def test_nobody_else_is_named_where_an_item_was_closed(world, queue, annotator):
    lost = next_item(annotator, world)
    close_item(lost.item)
    with pytest.raises(NoLongerYours) as refused:
        finish(lost)
    assert refused.value.code == "already_done"


def test_what_one_holds_already_is_not_somebody_else_s(world, queue, annotator, admin):
    item = queue.last()
    assign(item, annotator, by=admin)
    with pytest.raises(NotForThem) as refused:
        assign(item, annotator, by=admin)
    assert refused.value.code == "held_by_them"


def test_who_comes_back_before_anybody_else_has_lost_nothing(world, queue, annotator):
    held = next_item(annotator, world)
    expire(held)
    assert say(held).accepted_at
    assert not queue.filter(pk=held.item_id).exists()


def test_what_one_skips_others_get(world, queue, annotator, berta):
    skipped = next_item(annotator, world)
    skip(skipped)
    others = [next_item(annotator, world)]
    say(others[0])
    others.append(next_item(annotator, world))
    say(others[1])
    assert skipped.item_id not in {each.item_id for each in others}
    assert next_item(annotator, world) is None
    assert next_item(berta, world).item_id == skipped.item_id


def test_what_one_gives_back_comes_last(world, queue, annotator):
    given_back = next_item(annotator, world)
    give_back(given_back)
    for _ in range(2):
        other = next_item(annotator, world)
        assert other.item_id != given_back.item_id
        say(other)
    assert next_item(annotator, world).item_id == given_back.item_id


def test_an_answer_is_taken_back_with_its_item(world, queue, annotator):
    held = next_item(annotator, world)
    label = say(held)
    take_answer_back(label, annotator)
    held.item.utterance.refresh_from_db()
    assert held.item.utterance.status == "unlabelled"
    assert next_item(annotator, world).item_id == held.item_id
    with pytest.raises(Refusal) as refused:
        take_answer_back(label, annotator)
    assert refused.value.code == "already_taken_back"


def test_a_skip_is_taken_back(world, queue, annotator):
    skipped = next_item(annotator, world)
    take_answer_back(say(skipped, "", Verdict.SKIP), annotator)
    assert next_item(annotator, world).item_id == skipped.item_id


def test_an_answer_that_nobody_asked_for_counts_for_the_queue(world, queue, utterances, berta):
    answer(utterances[1], Verdict.UNKNOWN, "", berta, 1)
    assert not queue.filter(utterance=utterances[1]).exists()


def test_what_was_labelled_elsewhere_is_not_given(world, queue, utterances, annotator, berta):
    label(utterances[0], Verdict.UNKNOWN, "", annotator, 1)
    assert next_item(berta, world).item.utterance == utterances[1]
    assert queue.count() == 2


def test_what_was_labelled_elsewhere_is_taken_from_who_holds_it(
    world, queue, utterances, annotator, admin
):
    held = next_item(annotator, world)
    label(utterances[0], Verdict.UNKNOWN, "", admin, 1)
    assert next_item(annotator, world).item_id != held.item_id


def test_an_answer_to_what_was_closed_meanwhile_is_taken_back(
    world, queue, annotator, admin, berta
):
    set_share(world, WorkKind.UNLABELLED, 100)
    first = say(next_item(annotator, world))
    labelled_elsewhere = first.utterance
    label(labelled_elsewhere, Verdict.UNKNOWN, "", admin, 1)
    next_item(berta, world)
    item = first.assignment.item
    item.refresh_from_db()
    assert (item.is_open, item.places) == (False, 0)
    take_answer_back(first, annotator)
    item.refresh_from_db()
    assert (item.is_open, item.places) == (True, 1)


def test_a_page_asks_for_more_than_it_has(world, queue, utterances, annotator):
    first = next_item(annotator, world, ItemFilter(labels_only=True))
    assert first.item.utterance == utterances[0]
    more = next_item(annotator, world, ItemFilter(labels_only=True, without=[utterances[0].pk]))
    assert more.item.utterance == utterances[1]
    assert next_item(annotator, world).item.utterance == utterances[0]


def test_an_admin_assigns_and_withdraws(world, queue, annotator, berta, admin):
    item = queue.last()
    given = assign(item, annotator, by=admin)
    assert given.leased_until is None
    assert next_item(annotator, world).item_id == item.pk
    with pytest.raises(NotForThem) as refused:
        assign(item, berta, by=admin)
    assert refused.value.code == "done_by_another"
    withdraw(given)
    assert assign(item, berta, by=admin).item_id == item.pk


def test_nothing_is_assigned_to_who_has_no_role_or_answered_it(
    world, queue, annotator, stranger, reviewer, admin
):
    item = queue.first()
    for person in (stranger, reviewer):
        with pytest.raises(NotForThem) as refused:
            assign(item, person, by=admin)
        assert refused.value.code == "no_role_for_it"
    say(next_item(annotator, world))
    with pytest.raises(NotForThem) as refused:
        take(annotator, item)
    assert refused.value.code == "already_done"


def test_a_reviewer_gets_no_labels_to_write(world, queue, reviewer):
    assert next_item(reviewer, world) is None


def test_shares_change_what_nobody_has_touched(world, queue, annotator):
    held = next_item(annotator, world)
    set_share(world, WorkKind.UNLABELLED, 100)
    assert sorted(queue.values_list("people", flat=True)) == [1, 2, 2]
    assert WorkItem.objects.get(pk=held.item_id).people == 1
    set_share(world, WorkKind.UNLABELLED, 0)
    assert set(queue.values_list("people", "places")) == {(1, 1), (1, 0)}
    with pytest.raises(Refusal) as refused:
        set_share(world, WorkKind.ADJUDICATION, 50)
    assert refused.value.code == "no_such_share"


def test_the_share_is_about_as_large_as_it_says(world, annotator):
    from annotations.labelling.enqueuing import draw_of, people_for

    draws = [draw_of("unlabelled", "utterance", key) for key in range(5000)]
    doubles = sum(people_for("unlabelled", "utterance", d, {"unlabelled": 20}) == 2 for d in draws)
    assert 900 < doubles < 1100


def test_whatever_people_do_the_places_add_up(world, queue, annotator, berta, carl, admin):
    """A hundred and fifty steps of four people: an open item has as many free places as it lacks people."""
    for_two = [row.pk for row in queue.order_by("pk")[:2]]
    queue.filter(pk__in=for_two).update(people=2, places=2)
    chance = random.Random(7)
    people = [annotator, berta, carl, admin]
    held: list[Assignment] = []
    for _ in range(150):
        step = chance.choice(["next", "next", "answer", "skip", "give back", "expire", "take back"])
        if step == "next":
            given = next_item(chance.choice(people), world)
            held += [given] if given else []
        elif held:
            act(step, chance.choice(held), chance)
        check_places(world)
    assert Label.objects.valid().exists()
    assert set(kinds(world)) <= set(WorkKind.values)


def act(step: str, assignment: Assignment, chance: random.Random) -> None:
    verbs = {"skip": skip, "give back": give_back, "expire": expire}
    assignment = Assignment.objects.filter(pk=assignment.pk).first()
    try:
        if assignment is None:
            return
        if step == "answer":
            say(assignment, chance.choice(["( a )", "( b )"]))
        elif step != "take back":
            verbs[step](assignment)
        elif assignment.label:
            take_answer_back(assignment.label, assignment.person)
    except NoLongerYours:
        pass


def check_places(world) -> None:
    occupied = Count("assignments", Q(assignments__outcome__in=[Outcome.HELD, Outcome.DONE]))
    for item in world.work_items.annotate(occupied=occupied):
        done = item.assignments.done().count()
        if item.is_open:
            assert item.places + item.occupied == item.people, item
            assert done < item.people
        else:
            assert (item.places, item.occupied) == (0, done), item
