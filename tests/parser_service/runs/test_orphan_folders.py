"""Folders on the disk go with their runs, and no others."""

from __future__ import annotations

from datetime import timedelta

from django.conf import settings
from django.utils import timezone

from annotations.exchange.world_deletion import delete_world
from parser_service.models import RunFolder
from parser_service.runs.checkpoints import run_folder
from parser_service.runs.orphan_folders import FORGET_AFTER, keep_track_of, remove_orphans
from tests.parser_service.requests import ask


def with_folder(split, **asked):
    run = ask(split, send=False, **asked)
    keep_track_of(run)
    (run_folder(run.pk) / "model").mkdir(parents=True, exist_ok=True)
    return run


def test_deleting_a_world_removes_the_folders_of_its_runs(world, split):
    gone = with_folder(split).pk
    delete_world(world)
    assert remove_orphans() == [gone]
    assert not run_folder(gone).exists()
    assert remove_orphans() == []


def test_folders_of_runs_that_are_there_and_of_other_databases_stay(split):
    kept = with_folder(split)
    unknown = settings.RUNS_DIR / "987654"
    unknown.mkdir(parents=True, exist_ok=True)
    assert remove_orphans() == []
    assert run_folder(kept.pk).exists() and unknown.exists()


def test_what_a_child_writes_late_is_removed_too_and_then_forgotten(split):
    run = with_folder(split)
    number = run.pk
    run.delete()
    remove_orphans()
    run_folder(number).mkdir(parents=True, exist_ok=True)
    assert remove_orphans() == [number]
    RunFolder.objects.update(orphaned_at=timezone.now() - FORGET_AFTER - timedelta(seconds=1))
    remove_orphans()
    assert not RunFolder.objects.exists()
