"""Worlds that nobody sees, because they are being imported or deleted, and what is left of them."""

from __future__ import annotations

import re

from django.utils import timezone

from annotations.background.sweeping import KEPT_FOR
from annotations.exchange.world_deletion import delete_world
from annotations.models import Job, JobKind, World

_HIDDEN_NAME = re.compile(r"importing-job-(?P<job>\d+)")


def hidden_name(job: Job) -> str:
    """Return what a world is called while ``job`` imports it."""
    return f"importing-job-{job.pk}"


def remove_hidden_worlds(name: str) -> None:
    for world in World.objects.filter(name=name, deletion_requested_at__isnull=False):
        delete_world(world)


def sweep_hidden_worlds() -> None:
    """Delete the hidden worlds that no job works on any more."""
    active = set(Job.objects.active().values_list("pk", flat=True))
    for world in World.objects.filter(deletion_requested_at__isnull=False):
        if match := _HIDDEN_NAME.fullmatch(world.name):
            is_forgotten = int(match["job"]) not in active  # it was being imported
        else:
            deletions = Job.objects.active().filter(
                kind=JobKind.DELETE_WORLD, world_name=world.name
            )
            requested_at = world.deletion_requested_at
            is_old = requested_at is not None and requested_at < timezone.now() - KEPT_FOR
            is_forgotten = is_old and not deletions.exists()
        if is_forgotten:
            delete_world(world)
