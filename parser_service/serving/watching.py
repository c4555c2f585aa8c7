"""What the parse server has to hold, as the database says now."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

from django.db.models import Count, Max, Sum

from annotations.models import Entity, Predicate, World
from parser_service.models import ActionNames, Promotion


@dataclass(frozen=True, slots=True)
class Wanted:
    """A world, the key of its promoted run (None: none), and what changes whenever its words do.

    ``language`` stands for ontology and predicates, ``revision`` for the grammar, ``names`` for those
    of actions.
    """

    world: int
    run: int | None
    language: tuple[object, ...]
    revision: int
    names: int = 0


def read_wanted() -> dict[str, Wanted]:
    """Return world name → what is wanted there, in five queries.

    Every edit and import of rows adds, deletes or raises a version, so that number, last key and sum of
    the versions together change.
    """
    language: dict[int, list[object]] = defaultdict(list)
    for model, path in ((Entity, "ontology__world"), (Predicate, "world")):
        totals = model.objects.order_by().values_list(path)
        for world, *of_world in totals.annotate(Count("pk"), Max("pk"), Sum("version")):
            language[world] += [model.__name__, *of_world]
    runs = dict(Promotion.objects.present().order_by().values_list("world", "run"))
    names = dict(ActionNames.objects.values_list("world", "version"))
    rows = World.objects.present().values_list("pk", "name", "revision")
    return {
        name: Wanted(key, runs.get(key), tuple(language[key]), revision, names.get(key, 0))
        for key, name, revision in rows
    }
