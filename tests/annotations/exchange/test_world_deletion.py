"""A world goes with all that is below it, and nothing else does."""

from __future__ import annotations

import pytest
from django.apps import apps
from django.db import connection

from annotations.background.progress import Unwatched
from annotations.exchange.world_deletion import delete_world, request_deletion
from annotations.models import World
from tests.sample_world import fill_world


def row_counts():
    models = (
        model
        for app in ("annotations", "parser_service")
        for model in apps.get_app_config(app).get_models()
    )
    return {model.__name__: model.objects.count() for model in models}


def test_everything_of_the_world_goes_and_nothing_of_another(world, other_world, annotator):
    fill_world(other_world)
    before = row_counts()
    empty = World.objects.create(name="third")
    fill_world(empty)
    delete_world(empty)
    assert row_counts() == before


def test_a_world_that_is_being_deleted_is_shown_to_nobody(world, annotator, superuser):
    request_deletion(world)
    assert not World.objects.visible_to(annotator).exists()
    assert not World.objects.visible_to(superuser).exists()


def test_an_interrupted_deletion_is_finished_by_the_next(world):
    fill_world(world)

    class Impatient(Unwatched):
        def report(self, fraction, message):
            if fraction > 0.3:
                raise InterruptedError

    with pytest.raises(InterruptedError):
        delete_world(world, Impatient())
    assert world.logical_forms.exists()
    delete_world(world)
    assert set(row_counts().values()) == {0}


def test_rows_go_in_short_transactions(world, monkeypatch, django_capture_on_commit_callbacks):
    monkeypatch.setattr("annotations.exchange.world_deletion.BATCH", 1)
    fill_world(world)
    statements = []
    with connection.execute_wrapper(
        lambda run, sql, *rest: (statements.append(sql), run(sql, *rest))[1]
    ):
        delete_world(world)
    deletions = [sql for sql in statements if sql.startswith('DELETE FROM "annotations_command"')]
    assert len(deletions) == 3
