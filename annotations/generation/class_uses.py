"""What uses a class of entities, and why it cannot be deleted."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import TypeAlias

from django.db.models import Model, Q

from annotations.language.texts import say_count
from annotations.models import Entity, EntityClass, Predicate, Production, SemanticTemplate

# The keys of rows, by their models.
Taken: TypeAlias = "Mapping[type[Model], Collection[int]]"


def why_kept(row: EntityClass, taken: Taken | None = None) -> str:
    """Return a sentence that says why the class cannot be deleted; empty where it can.

    ``taken`` are the keys of rows that are deleted with it.
    """
    uses = [say_count(number, noun) for noun, number in count_uses(row, taken).items() if number]
    if not uses:
        return ""
    *others, last = uses
    listed = f"{', '.join(others)} and {last}" if others else last
    return f"{listed} of this world use the class {row.token}. Change or delete them first."


def count_uses(row: EntityClass, taken: Taken | None = None) -> dict[str, int]:
    """Return how many entities, productions, templates and predicates use a class, by what they are called.

    Those whose keys are ``taken`` do not count.
    """
    taken = taken or {}
    wildcard = rf"\{{\s*{row.token}[^a-z_]"
    written = rf"{wildcard}|<{row.token}[0-9]*>"
    templates = SemanticTemplate.objects.filter(grammar__world=row.world)
    templates = templates.exclude(pk__in=taken.get(SemanticTemplate, ()))
    productions = Production.objects.filter(grammar__world=row.world)
    productions = productions.exclude(pk__in=taken.get(Production, ()))
    entities = Entity.objects.filter(ontology__world=row.world, entity_class=row.token)
    entities = entities.exclude(pk__in=taken.get(Entity, ()))
    predicates = row.world.predicates.exclude(pk__in=taken.get(Predicate, ()))
    signatures = predicates.values_list("signatures", flat=True)
    return {
        "entity": entities.count(),
        "production": productions.filter(expansion__iregex=wildcard).count(),
        "template": templates.filter(Q(pattern__iregex=wildcard) | Q(form__iregex=written)).count(),
        "predicate": sum(any(row.token in each for each in kinds) for kinds in signatures),
    }
