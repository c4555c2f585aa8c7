"""Verb: delete a class of entities that nothing uses."""

from __future__ import annotations

from http import HTTPStatus

from django.db import transaction
from django.db.models import Q

from annotations.editing.edits import delete
from annotations.language.english import say_count
from annotations.language.errors import Refusal
from annotations.models import (
    Entity,
    EntityClass,
    Production,
    SemanticTemplate,
    User,
    World,
)


def delete_class(row: EntityClass, by: User, version: int) -> None:
    """Delete ``row``, which ``by`` saw at ``version``.

    Raises Refusal where every world has the class or something of its world uses it, and Overtaken where the
    row is at another version or was deleted already.
    """
    with transaction.atomic():
        World.objects.select_for_update().get(pk=row.world_id)  # nothing uses it from here on
        if reason := why_kept(row):
            raise Refusal(reason, "in_use", HTTPStatus.CONFLICT)
        delete(row, by, version)


def why_kept(row: EntityClass) -> str:
    """Return a sentence that says why the class cannot be deleted; empty where it can."""
    if row.is_of_every_world:
        return f"Every world has the class {row.token}. It cannot be deleted."
    uses = [say_count(number, noun) for noun, number in count_uses(row).items() if number]
    if not uses:
        return ""
    *others, last = uses
    listed = f"{', '.join(others)} and {last}" if others else last
    return f"{listed} of this world use the class {row.token}. Change or delete them first."


def count_uses(row: EntityClass) -> dict[str, int]:
    """Return how many entities, productions, templates and predicates use a class, by what they are called."""
    wildcard = rf"\{{\s*{row.token}[^a-z_]"
    written = rf"{wildcard}|<{row.token}[0-9]*>"
    templates = SemanticTemplate.objects.filter(grammar__world=row.world)
    productions = Production.objects.filter(grammar__world=row.world)
    entities = Entity.objects.filter(ontology__world=row.world, entity_class=row.token)
    signatures = row.world.predicates.values_list("signatures", flat=True)
    return {
        "entity": entities.count(),
        "production": productions.filter(expansion__iregex=wildcard).count(),
        "template": templates.filter(Q(pattern__iregex=wildcard) | Q(form__iregex=written)).count(),
        "predicate": sum(any(row.token in each for each in kinds) for kinds in signatures),
    }
