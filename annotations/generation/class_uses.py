"""What uses a class of entities, and why it cannot be deleted."""

from __future__ import annotations

from django.db.models import Q

from annotations.language.texts import say_count
from annotations.models import Entity, EntityClass, Production, SemanticTemplate


def why_kept(row: EntityClass) -> str:
    """Return a sentence that says why the class cannot be deleted; empty where it can."""
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
