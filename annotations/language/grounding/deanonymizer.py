"""Replace class tokens of a form with the entities that the utterance names, where that is certain."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from annotations.language.forms import Application, Constant, Form, Lambda, Unknown, children
from annotations.language.grounding.anonymizer import Anonymized, Span
from annotations.language.ontology import Ontology

SlotPath = tuple[int, ...]
_NUMBER = re.compile(r"\d+(?=>?$)")


@dataclass(frozen=True, slots=True)
class Slot:
    """A place in a form that needs a value.

    ``path`` leads to it by child numbers; ``entity_class`` is empty for an UNKNOWN argument.
    ``candidates`` are the values that the utterance offers (in its order), or else those of the
    ontology; ``value`` is the certain one, None for an open or ambiguous slot.
    """

    path: SlotPath
    token: str
    entity_class: str
    candidates: tuple[str, ...] = ()
    is_named: bool = False
    value: str | None = None

    @property
    def is_ambiguous(self) -> bool:
        """Whether the utterance names several entities that fit here."""
        return self.value is None and self.is_named


@dataclass(frozen=True, slots=True)
class Deanonymized:
    """A form with every certain entity in it, and all of its slots in order."""

    form: Form
    slots: tuple[Slot, ...]

    @property
    def open_slots(self) -> tuple[Slot, ...]:
        """The slots without a value, including the ambiguous ones."""
        return tuple(slot for slot in self.slots if slot.value is None)


def deanonymize(form: Form, anonymized: Anonymized, ontology: Ontology) -> Deanonymized:
    """Put the entities of an utterance back into the form that a parser gave for it.

    A numbered token takes the value of its number. Otherwise a class is certain if all mentions of
    it have the same value and the form has no more slots of it than there are mentions. If it is
    not certain, its slots stay as they are and offer the mentioned values.
    """
    slots = tuple(slots_of(form))
    resolved = tuple(_resolve(slot, slots, anonymized.spans, ontology) for slot in slots)
    for slot in resolved:
        if slot.value is not None:
            form = filled(form, slot.path, slot.value)
    return Deanonymized(form, resolved)


def filled(form: Form, path: SlotPath, value: str) -> Form:
    """Return the form with a constant at a path."""
    if not path:
        return Constant(value)
    place, *rest = path
    parts = list(children(form))
    parts[place] = filled(parts[place], tuple(rest), value)
    if isinstance(form, Lambda):
        return replace(form, bodies=tuple(parts))
    if isinstance(form, Application):
        return replace(form, arguments=tuple(parts))
    raise IndexError(f"a leaf has no part {place}")


def slots_of(form: Form, path: SlotPath = ()) -> Iterator[Slot]:
    """Yield the class tokens and UNKNOWN arguments of a form, in order, without candidates."""
    if isinstance(form, Constant) and form.token_class:
        yield Slot(path, str(form.value), form.token_class)
    elif isinstance(form, Unknown) and path:
        yield Slot(path, "UNKNOWN", "")
    for place, child in enumerate(children(form)):
        yield from slots_of(child, (*path, place))


def _resolve(slot: Slot, slots: Sequence[Slot], spans: Sequence[Span], ontology: Ontology) -> Slot:
    number = _NUMBER.search(slot.token)
    mentions = [span for span in spans if span.entity_class == slot.entity_class]
    values = tuple(dict.fromkeys(span.value for span in mentions))
    if number and not any(_NUMBER.search(span.token) for span in mentions):
        mentions = mentions[int(number[0]) :][:1]
        values = tuple(span.value for span in mentions)
    elif number:
        mentions = [span for span in mentions if _NUMBER.findall(span.token) == [number[0]]]
        values = tuple(dict.fromkeys(span.value for span in mentions))
    if not values:
        known = (entity.text for entity in ontology.of_class(slot.entity_class))
        return replace(slot, candidates=tuple(dict.fromkeys(known)))
    rivals = sum(other.token == slot.token for other in slots)
    is_certain = len(values) == 1 and (bool(number) or rivals <= len(mentions))
    value = values[0] if is_certain else None
    return replace(slot, candidates=values, is_named=True, value=value)
