"""Verb: delete a world with everything below it, in short transactions, so that nobody waits for it."""

from __future__ import annotations

from collections.abc import Iterator
from graphlib import TopologicalSorter

from django.db import models
from django.utils import timezone

from annotations.background.progress import UNWATCHED, Progress
from annotations.models import World
from annotations.rows.synchronise import BATCH

# Model → the paths by which its rows belong to a world.
Paths = dict[type[models.Model], list[str]]


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
            progress.report(deleted / total, f"deleting {model._meta.verbose_name_plural}")
            deleted += len(keys)
            model._default_manager.filter(pk__in=keys).delete()
    with progress.writing():
        world.delete()
        progress.conclude({"rows": deleted + 1})
    return deleted + 1


def request_deletion(world: World) -> None:
    """Hide the world from everybody; ``delete_world`` removes what is in it."""
    World.objects.filter(pk=world.pk).update(deletion_requested_at=timezone.now())


def count_below(world: World) -> dict[type[models.Model], int]:
    """Return how many rows each model has below ``world``, in an order in which they can be deleted."""
    paths = _paths_to_world()
    counts = {model: _count(model, world, paths[model]) for model in _deletion_order(paths)}
    return {model: count for model, count in counts.items() if count}


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
    return [each for each in fields if each.auto_created and not each.concrete]


def _deletion_order(paths: Paths) -> list[type[models.Model]]:
    """Return the models in an order in which rows that refer to others come before these."""
    sorter: TopologicalSorter[type[models.Model]] = TopologicalSorter()
    for model in paths:
        referring = {relation.related_model for relation in _relations_to(model)}
        sorter.add(model, *((referring & paths.keys()) - {model}))
    return list(sorter.static_order())


def _count(model: type[models.Model], world: World, paths: list[str]) -> int:
    belongs = models.Q()
    for path in paths:
        belongs |= models.Q(**{path: world.pk})
    return model._default_manager.filter(belongs).count()


def _batches_of_keys(
    model: type[models.Model], world: World, paths: list[str]
) -> Iterator[list[int]]:
    """Yield keys of rows that still exist; the caller deletes each batch before it asks for the next."""
    for path in paths:
        rows = model._default_manager.filter(**{path: world.pk}).order_by()
        while keys := list(rows.values_list("pk", flat=True)[:BATCH]):
            yield keys
