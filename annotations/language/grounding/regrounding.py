"""Put the entities of a labelled pair into another form for the same words."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence

from annotations.language.forms import Constant, Form, children
from annotations.language.grounding.deanonymizer import Slot, filled, slots_of
from annotations.language.grounding.roles import SlotPath


def ground_like(form: Form, label: Form, grounded: Form) -> Form:
    """Return ``form`` with the entities that ``grounded`` has where ``label`` has class tokens.

    The entities of a class are certain where ``label`` names only one, or where both forms have as many
    tokens of the class: then they keep their order. The other tokens stay as they are.
    """
    known = _entities_by_class(label, grounded)
    slots = [slot for slot in slots_of(form) if slot.entity_class]
    for entity_class, entities in known.items():
        places = [slot.path for slot in slots if slot.entity_class == entity_class]
        for path, entity in _certain(places, entities):
            form = filled(form, path, entity)
    return form


def _entities_by_class(label: Form, grounded: Form) -> Mapping[str, Sequence[str]]:
    known: dict[str, list[str]] = defaultdict(list)
    for slot in slots_of(label):
        if entity := _text_at(grounded, slot):
            known[slot.entity_class].append(entity)
    return known


def _text_at(form: Form, slot: Slot) -> str:
    """Return the text of the constant in the place of ``slot``; empty where there is none."""
    for place in slot.path:
        parts = children(form)
        if place >= len(parts):
            return ""
        form = parts[place]
    return str(form.value) if isinstance(form, Constant) and slot.entity_class else ""


def _certain(places: Sequence[SlotPath], entities: Sequence[str]) -> list[tuple[SlotPath, str]]:
    if len(set(entities)) == 1:
        return [(path, entities[0]) for path in places]
    return list(zip(places, entities, strict=True)) if len(places) == len(entities) else []
