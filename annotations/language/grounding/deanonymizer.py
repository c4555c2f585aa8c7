"""Replace class tokens of a form with the entities that the utterance names (Walker et al. 2019, §3.3)."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from annotations.language.forms import Application, Constant, Form, Lambda, Unknown, children
from annotations.language.grounding.anonymizer import Anonymized, Span
from annotations.language.grounding.assignment import Choice, Mention, assign
from annotations.language.grounding.evidence import Evidence, default_evidence
from annotations.language.grounding.roles import SlotPath, context_of, role_of, words_of
from annotations.language.grounding.unknown_phrases import unknown_phrases
from annotations.language.ontology import Ontology

_NUMBER = re.compile(r"\d+(?=>?$)")


@dataclass(frozen=True, slots=True)
class Slot:
    """A place in a form that needs a value.

    ``path`` leads to it by child numbers; ``entity_class`` is empty for an UNKNOWN argument.
    ``value`` is the certain one, None for an open slot; ``likely`` is the most likely of several that
    the utterance names. ``candidates`` are the values that the utterance offers (``is_named``), or else those of
    the ontology. ``phrases`` are words of the utterance that may name it and that nothing explains.
    """

    path: SlotPath
    token: str
    entity_class: str
    candidates: tuple[str, ...] = ()
    is_named: bool = False
    value: str | None = None
    likely: str | None = None
    phrases: tuple[str, ...] = ()

    @property
    def is_ambiguous(self) -> bool:
        """Whether the utterance names entities that may fit here."""
        return self.value is None and self.is_named


@dataclass(frozen=True, slots=True)
class Deanonymized:
    """``form`` has every certain and every likely entity in it; ``slots`` are all slots, in order."""

    form: Form
    slots: tuple[Slot, ...]

    @property
    def open_slots(self) -> tuple[Slot, ...]:
        """The slots to ask about: without a certain value."""
        return tuple(slot for slot in self.slots if slot.value is None)


def deanonymize(
    form: Form, anonymized: Anonymized, ontology: Ontology, evidence: Evidence | None = None
) -> Deanonymized:
    """Put the entities of an utterance back into the form that a parser gave for it.

    A numbered token takes the value of its number. Where the utterance names one value of a class,
    and not fewer times than the form has slots of it, it fills them. Several values get the most
    likely assignment by ``evidence`` (of English alone if there is none); a slot of which the evidence leaves it
    open which value it gets stays open and has a likely value.
    """
    slots = tuple(slots_of(form))
    phrases = unknown_phrases(anonymized, ontology)
    resolved = _resolve(form, slots, anonymized, evidence or default_evidence(), phrases)
    offered = (_offer(slot, ontology, phrases) for slot in resolved)
    return fill_all(form, tuple(offered))


def fill_all(form: Form, slots: tuple[Slot, ...]) -> Deanonymized:
    """Return the form with the certain and the likely values of the slots."""
    for slot in slots:
        value = slot.value if slot.value is not None else slot.likely
        if value is not None:
            form = filled(form, slot.path, value)
    return Deanonymized(form, slots)


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


def _resolve(
    form: Form,
    slots: Sequence[Slot],
    anonymized: Anonymized,
    evidence: Evidence,
    phrases: Mapping[str, tuple[str, ...]],
) -> list[Slot]:
    """Return the slots with the values of the mentions that fit them.

    One value for several slots is not certain where an unknown word may be one of them.
    """
    values: dict[SlotPath, Slot] = {}
    for entity_class in dict.fromkeys(slot.entity_class for slot in slots if slot.entity_class):
        spans = [span for span in anonymized.spans if span.entity_class == entity_class]
        mine = [slot for slot in slots if slot.entity_class == entity_class]
        by_number = [slot for slot in mine if _NUMBER.search(slot.token)]
        for slot in by_number:
            values[slot.path] = _by_number(slot, spans)
        plain = [slot for slot in mine if slot not in by_number]
        choices = assign(
            form,
            entity_class,
            [role_of(form, slot.path) for slot in plain],
            _mentions(anonymized, entity_class),
            evidence,
        )
        named = tuple(dict.fromkeys(span.value for span in spans))
        is_doubtful = len(plain) > len(named) == 1 and bool(phrases.get(entity_class))
        for slot, choice in zip(plain, choices, strict=True):
            values[slot.path] = _with_choice(slot, choice, named, is_doubtful)
    return [values.get(slot.path, slot) for slot in slots]


def _with_choice(slot: Slot, choice: Choice, named: tuple[str, ...], is_doubtful: bool) -> Slot:
    is_certain = choice.is_certain and not is_doubtful
    value, likely = (choice.value, None) if is_certain else (None, choice.value)
    return replace(slot, candidates=named, is_named=bool(named), value=value, likely=likely)


def _by_number(slot: Slot, spans: Sequence[Span]) -> Slot:
    """Give a numbered token the value of its number: that of the token, or else of the mention."""
    number = slot.token.strip("<>").removeprefix(slot.entity_class)
    if any(_NUMBER.search(span.token) for span in spans):
        spans = [span for span in spans if _NUMBER.findall(span.token) == [number]]
    else:
        spans = spans[int(number) :][:1]
    named = tuple(dict.fromkeys(span.value for span in spans))
    value = named[0] if len(named) == 1 else None
    return replace(slot, candidates=named, is_named=bool(named), value=value)


def _mentions(anonymized: Anonymized, entity_class: str) -> list[Mention]:
    """Return the mentions of a class with their contexts in the anonymized utterance."""
    words: list[str] = []
    places: list[int] = []
    end = 0
    for span in anonymized.spans:
        words += words_of(anonymized.original[end : span.start])
        places.append(len(words))
        words.append(f"<{span.entity_class}>")
        end = span.end
    words += words_of(anonymized.original[end:])
    return [
        Mention(span.value, context_of(words, place), (span.entity, *span.others))
        for span, place in zip(anonymized.spans, places, strict=True)
        if span.entity_class == entity_class
    ]


def _offer(slot: Slot, ontology: Ontology, phrases: Mapping[str, tuple[str, ...]]) -> Slot:
    """Give an open slot that nobody named the unknown words of the utterance, and the entities of its class."""
    if slot.value is not None or slot.is_named:
        return slot
    known = (entity.text for entity in ontology.of_class(slot.entity_class))
    words = phrases.get(slot.entity_class, phrases[""])
    return replace(slot, candidates=tuple(dict.fromkeys(known)), phrases=words)
