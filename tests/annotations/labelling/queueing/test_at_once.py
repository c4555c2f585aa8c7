"""Many people ask at the same time, on the real database: each place of an item goes to one of them."""

from __future__ import annotations

from collections import Counter
from concurrent.futures import ThreadPoolExecutor

import pytest
from django.db import connections

from annotations.labelling.enqueuing import refill, set_share
from annotations.labelling.giving import next_item
from annotations.labelling.item_answers import answer
from annotations.models import Assignment, Utterance, Verdict, WorkKind, World
from annotations.models.queueing import Outcome
from annotations.models.worlds import Role
from tests.conftest import member

pytestmark = pytest.mark.django_db(transaction=True)

PEOPLE, ITEMS = 8, 40


def work(person, world) -> list[int]:
    """Do items until there is none left. Returns their keys."""
    try:
        items = []
        while assignment := next_item(person, world):
            items.append(assignment.item_id)
            answer(assignment.item.utterance, Verdict.UNKNOWN, "", person, 1)
        return items
    finally:
        connections.close_all()


@pytest.mark.parametrize("share", [0, 100])
def test_no_place_is_given_twice(share):
    world = World.objects.create(name="home")
    people = [member(world, f"person{number}", Role.ANNOTATOR) for number in range(PEOPLE)]
    Utterance.objects.bulk_create(
        Utterance(world=world, text=f"bring me {number}", anonymized_text="")
        for number in range(ITEMS)
    )
    set_share(world, WorkKind.UNLABELLED, share)
    refill(world)
    with ThreadPoolExecutor(PEOPLE) as threads:
        done = list(threads.map(lambda person: work(person, world), people))
    times = Counter(item for items in done for item in items)
    assert len(times) == ITEMS
    assert set(times.values()) == {2 if share else 1}
    assert Assignment.objects.filter(outcome=Outcome.DONE).count() == sum(times.values())
    assert not world.work_items.open().exists()
    assert world.utterances.filter(status="unknown").count() == ITEMS
    assert all(len(set(items)) == len(items) for items in done)
