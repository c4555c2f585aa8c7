"""Verb: delete a world with everything below it, in short transactions, so that nobody waits for it."""

from __future__ import annotations

from array import array
from collections.abc import Iterator, Sequence
from graphlib import TopologicalSorter
from typing import Any

from django.db import connection, models
from django.utils import timezone

from annotations.background.job_weight import MOST_ROWS
from annotations.background.progress import UNWATCHED, Progress
from annotations.background.requesting import request_job
from annotations.background.watching import JobProgress
from annotations.models import Job, JobKind, User, World
from annotations.rows.rows_in_words import rows_in_words
from annotations.rows.synchronise import BATCH

# Model → the path by which its rows belong to a world.
Paths = dict[type[models.Model], str]


def start_deletion(world: World, by: User) -> Job | int:
    """Delete now and return the number of rows, or hide the world and return the job that deletes it."""
    if is_heavy_deletion(world):
        request_deletion(world)
        return request_job(JobKind.DELETE_WORLD, world.name, by)
    return delete_world(world)


def is_heavy_deletion(world: World) -> bool:
    return sum(count_below(world, MOST_ROWS + 1).values()) > MOST_ROWS


def delete_world_of(job: Job, progress: JobProgress) -> dict[str, Any]:
    world = World.objects.filter(name=job.world_name, deletion_requested_at__isnull=False).first()
    return {"rows": delete_world(world, progress)} if world else {"rows": 0}


def delete_world(world: World, progress: Progress = UNWATCHED) -> int:
    """Delete ``world`` and return the number of rows that went, its own included.

    The world is invisible from the first moment. When this is interrupted, a second call goes on
    where the first one stopped.
    """
    request_deletion(world)
    counts, paths = count_below(world), paths_to_world()
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


def count_below(world: World, most: int | None = None) -> dict[type[models.Model], int]:
    """Return how many rows each model has below ``world``, at most ``most`` each, in an order in which they can be
    deleted.

    Deleted utterances count: their rows are there. One query for all of them.
    """
    paths = paths_to_world()
    order = deletion_order(paths)
    parts: list[str] = []
    values: list[Any] = []
    for number, model in enumerate(order):
        rows = model._base_manager.filter(**{paths[model]: world.pk}).order_by().values("pk")
        sql, given = rows[:most].query.sql_with_params()
        parts.append(f"SELECT {number}, COUNT(*) FROM ({sql}) AS below")
        values += given
    with connection.cursor() as cursor:
        cursor.execute(" UNION ALL ".join(parts), values)
        counts = dict(cursor.fetchall())
    return {model: counts[number] for number, model in enumerate(order) if counts[number]}


def paths_to_world() -> Paths:
    """Return every model whose rows go with a world, whichever application it is of.

    Where rows belong to it by several paths, these lead to the same world; the shortest one is taken, of those that
    every row has.
    """
    paths: dict[type[models.Model], list[tuple[bool, int, str]]] = {}
    pending: list[tuple[type[models.Model], str, bool]] = [(World, "", False)]
    while pending:
        parent, path, is_partial = pending.pop()
        for relation in _relations_to(parent):
            child, field = relation.related_model, relation.field
            if relation.on_delete in (models.CASCADE, models.DO_NOTHING):
                found = f"{field.name}__{path}" if path else field.name
                some_lack_it = is_partial or field.null
                paths.setdefault(child, []).append((some_lack_it, found.count("__"), found))
                pending.append((child, found, some_lack_it))
    return {model: min(found)[-1] for model, found in paths.items()}


def _relations_to(model: type[models.Model]) -> list[models.ForeignObjectRel]:
    """Return what refers to rows of the model, its history included, whose relations have no name."""
    fields = model._meta.get_fields(include_hidden=True)
    return [each for each in fields if isinstance(each, models.ForeignObjectRel)]


def deletion_order(paths: Paths) -> list[type[models.Model]]:
    """Return the models in an order in which rows that refer to others come before these."""
    sorter: TopologicalSorter[type[models.Model]] = TopologicalSorter()
    for model in paths:
        referring = {relation.related_model for relation in _relations_to(model)}
        sorter.add(model, *((referring & paths.keys()) - {model}))
    return list(sorter.static_order())


def _batches_of_keys(model: type[models.Model], world: World, path: str) -> Iterator[Sequence[int]]:
    """Yield keys of rows that still exist; the caller deletes each batch before it asks for the next.

    All keys are read at once, eight bytes each: asking anew for the first ones would pass over all that were deleted.
    """
    rows = model._base_manager.filter(**{path: world.pk}).order_by().values_list("pk", flat=True)
    while keys := array("q", rows.iterator()):
        yield from (keys[start : start + BATCH] for start in range(0, len(keys), BATCH))
