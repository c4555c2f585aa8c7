"""Limits hold for all processes together, and for events at the same time."""

from __future__ import annotations

import threading

import pytest
from django.db import connection

from annotations.people.rate_limits import Rate

THREE = Rate("three", limit=3, seconds=60)


def test_there_are_as_many_places_as_the_limit_says(db):
    assert [bool(THREE.take("a")) for _ in range(5)] == [True, True, True, False, False]
    assert (THREE.left("a"), THREE.left("b")) == (0, 3)


def test_a_place_is_given_back(db):
    place = THREE.take("a")
    THREE.take("a")
    THREE.give_back(place)
    assert THREE.left("a") == 2


def test_an_event_expires_by_itself(db):
    short = Rate("short", limit=1, seconds=-1)
    assert short.take("a") and short.take("a")


@pytest.mark.parametrize("key", ["", "a" * 100_000, "\udcff", "a\0b", "名"])
def test_any_text_is_a_key(key, db):
    assert THREE.take(key)


def test_many_at_once_do_not_share_a_place(transactional_db):
    taken = []

    def try_often():
        taken.extend(filter(None, [THREE.take("a") for _ in range(3)]))
        connection.close()

    threads = [threading.Thread(target=try_often) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(taken) == 3
