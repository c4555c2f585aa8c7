"""Rows that are written again are those that were made."""

from collections import defaultdict

import pytest
from django.db import connection, transaction

from annotations.models import World
from tests import replaying
from tests.replaying import columns_of_tables, last_ids, made_once, rows_of
from tests.sample_world import fill_world

only_sqlite = pytest.mark.skipif(
    connection.vendor != "sqlite", reason="elsewhere they are made each time"
)


def all_rows():
    """The rows of each table, and the ids that the next ones count on from."""
    return {name: rows_of(name, columns) for name, columns in columns_of_tables()}, last_ids()


def undone(fill, world):
    """What ``fill`` returns and leaves behind in the database, which is as before in the end."""
    with transaction.atomic():
        returned = made_once(fill, world)
        rows = all_rows()
        transaction.set_rollback(True)
    return returned, rows


@only_sqlite
def test_what_is_repeated_is_what_was_made(world, monkeypatch):
    monkeypatch.setattr(replaying, "RECORDINGS", defaultdict(list))
    before = all_rows()
    made, rows = undone(fill_world, World.objects.get())
    repeated, again = undone(fill_world, World.objects.get())
    assert repeated == made and repeated.run is not made.run
    assert again == rows != before == all_rows()


@only_sqlite
def test_rows_that_were_there_keep_what_was_not_changed(world, monkeypatch):
    monkeypatch.setattr(replaying, "RECORDINGS", defaultdict(list))
    kept = World.objects.create(name="kept", description="as it was")

    def fill(world):
        World.objects.filter(pk=kept.pk).update(name="renamed")
        World.objects.filter(pk=world.pk).delete()

    undone(fill, world)
    World.objects.filter(pk=kept.pk).update(description="later")
    undone(fill, world)
    made_once(fill, world)
    assert list(World.objects.values_list("name", "description")) == [("renamed", "later")]
