"""Verb: delete a world with everything below it, in short transactions, so that nobody waits for it."""

from __future__ import annotations

from collections.abc import Iterator
from graphlib import TopologicalSorter
from typing import Any

from django.db import models
from django.utils import timezone

from annotations.background.job_weight import MOST_ROWS
from annotations.background.progress import UNWATCHED, Progress
from annotations.background.requesting import request_job
from annotations.background.watching import JobProgress
from annotations.models import Job, JobKind, User, World
from annotations.rows.rows_in_words import rows_in_words
from annotations.rows.synchronise import BATCH

# Model → the paths by which its rows belong to a world.
Paths = dict[type[models.Model], list[str]]


def start_deletion(world: World, by: User) -> Job | int:
    """Delete now and return the number of rows, or hide the world and return the job that deletes it."""
    if is_heavy_deletion(world):
        request_deletion(world)
        return request_job(JobKind.DELETE_WORLD, world.name, by)
    return delete_world(world)


def is_heavy_deletion(world: World) -> bool:
    return sum(count_below(world).values()) > MOST_ROWS


def delete_world_of(job: Job, progress: JobProgress) -> dict[str, Any]:
    world = World.objects.filter(name=job.world_name, deletion_requested_at__isnull=False).first()
    return {"rows": delete_world(world, progress)} if world else {"rows": 0}


def delete_world(world: World, progress: Progress = UNWATCHED) -> int:
    """Delete ``world`` and return the number of rows that went, its own included.

    The world is invisible from the first moment. When this is interrupted, a second call goes on
    where the first one stopped.
    """
    request_deletion(world)
    counts, paths = count_below(world), _paths_to_world()
    total, deleted = sum(counts.values()) or 1, 0
    for model in counts:
        for keys in _batches_of_keys(model, world, paths[model]):
            progress.check()
            progress.report(deleted / total, f"deleting {rows_in_words(model)}")
            deleted += len(keys)
            model._base_manager.filter(pk__in=keys).delete()
    with progress.writing():
        world.delete()
        progress.conclude({"rows": deleted + 1})
    return deleted + 1


def request_deletion(world: World) -> None:
    """Hide the world from everybody; ``delete_world`` removes what is in it."""
    World.objects.filter(pk=world.pk).update(deletion_requested_at=timezone.now())


def count_below(world: World) -> dict[type[models.Model], int]:
    """Return how many rows each model has below ``world``, in an order in which they can be deleted.

    Deleted utterances count: their rows are there. One query for all of them.
    """
    paths = _paths_to_world()
    order = _deletion_order(paths)
    first, *others = (
        model._base_manager.filter(
            models.Q(*((path, world.pk) for path in paths[model]), _connector=models.Q.OR)
        )
        .order_by()
        .annotate(model_number=models.Value(number))
        .values("model_number")
        .annotate(rows_below=models.Count("pk"))
        .values_list("model_number", "rows_below")
        for number, model in enumerate(order)
    )
    counts = dict(first.union(*others, all=True))
    return {model: counts[number] for number, model in enumerate(order) if number in counts}


def _paths_to_world() -> Paths:
    """Return every model whose rows go with a world, whichever application it is of."""
    paths: Paths = {}
    pending: list[tuple[type[models.Model], str]] = [(World, "")]
    while pending:
        parent, path = pending.pop()
        for relation in _relations_to(parent):
            child, name = relation.related_model, relation.field.name
            if relation.on_delete in (models.CASCADE, models.DO_NOTHING):
                paths.setdefault(child, []).append(f"{name}__{path}" if path else name)
                pending.append((child, paths[child][-1]))
    return paths


def _relations_to(model: type[models.Model]) -> list[models.ForeignObjectRel]:
    """Return what refers to rows of the model, its history included, whose relations have no name."""
    fields = model._meta.get_fields(include_hidden=True)
    return [each for each in fields if isinstance(each, models.ForeignObjectRel)]


def _deletion_order(paths: Paths) -> list[type[models.Model]]:
    """Return the models in an order in which rows that refer to others come before these."""
    sorter: TopologicalSorter[type[models.Model]] = TopologicalSorter()
    for model in paths:
        referring = {relation.related_model for relation in _relations_to(model)}
        sorter.add(model, *((referring & paths.keys()) - {model}))
    return list(sorter.static_order())


def _batches_of_keys(
    model: type[models.Model], world: World, paths: list[str]
) -> Iterator[list[int]]:
    """Yield keys of rows that still exist; the caller deletes each batch before it asks for the next."""
    for path in paths:
        rows = model._base_manager.filter(**{path: world.pk}).order_by()
        while keys := list(rows.values_list("pk", flat=True)[:BATCH]):
            yield keys
