"""Replace class tokens of a form with the entities that the utterance names (Walker et al. 2019, §3.3)."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from annotations.language.forms import (
    Application,
    Constant,
    Form,
    Lambda,
    Unknown,
    canonical_text,
    children,
)
from annotations.language.grounding.anonymizer import Anonymized, Span
from annotations.language.grounding.assignment import Choice, Mention, assign
from annotations.language.grounding.evidence import Evidence, default_evidence
from annotations.language.grounding.heard import Heard
from annotations.language.grounding.roles import Role, SlotPath, role_of
from annotations.language.ontology import Ontology

_NUMBER = re.compile(r"\d+(?=>?$)")


@dataclass(frozen=True, slots=True)
class Slot:
    """A place in a form that needs a value.

    ``path`` leads to it by child numbers; ``entity_class`` is empty for an UNKNOWN argument.
    ``value`` is the certain one, None for an open slot; ``likely`` is the most likely of several that
    the utterance names. ``candidates`` are the values that the utterance offers (``is_named``), or else those of
    the ontology. ``phrases`` are words of the utterance that may name it and that nothing explains.
    ``is_choice``: the utterance joins the candidates and phrases with "or", and one of them is meant.
    """

    path: SlotPath
    token: str
    entity_class: str
    candidates: tuple[str, ...] = ()
    is_named: bool = False
    value: str | None = None
    likely: str | None = None
    phrases: tuple[str, ...] = ()
    is_choice: bool = False

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
    open which value it gets stays open and has a likely value. So does one for which the utterance
    names several by "or", unless the grammar has this form with an "or".
    """
    known = evidence or default_evidence()
    heard = Heard(anonymized, ontology)
    return fill_all(form, resolve_slots(FormSlots.of(form), heard, ontology, known))


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
    place, rest = path[0], path[1:]
    parts = list(children(form))
    parts[place] = filled(parts[place], rest, value)
    if isinstance(form, Lambda):
        return Lambda(form.variable, form.type, tuple(parts))
    if isinstance(form, Application):
        return Application(form.predicate, tuple(parts))
    raise IndexError(f"a leaf has no part {place}")


def slots_of(form: Form, path: SlotPath = ()) -> Iterator[Slot]:
    """Yield the class tokens and UNKNOWN arguments of a form, in order, without candidates."""
    if isinstance(form, Constant) and form.token_class:
        yield Slot(path, str(form.value), form.token_class)
    elif isinstance(form, Unknown) and path:
        yield Slot(path, "UNKNOWN", "")
    for place, child in enumerate(children(form)):
        yield from slots_of(child, (*path, place))


@dataclass(frozen=True, slots=True)
class _OfClass:
    """The slots of one class: those with a number, and the others with their roles."""

    numbered: tuple[Slot, ...]
    plain: tuple[Slot, ...]
    roles: tuple[Role, ...]
    other_classes: frozenset[str]


@dataclass(frozen=True, slots=True)
class FormSlots:
    """The slots of a form and all that is known of them without an utterance. ``text`` is canonical."""

    text: str
    slots: tuple[Slot, ...]
    by_class: Mapping[str, _OfClass]

    @classmethod
    def of(cls, form: Form) -> FormSlots:
        slots = tuple(slots_of(form))
        classes = tuple(dict.fromkeys(slot.entity_class for slot in slots if slot.entity_class))
        by_class = {}
        for entity_class in classes:
            mine = [slot for slot in slots if slot.entity_class == entity_class]
            plain = tuple(slot for slot in mine if not _NUMBER.search(slot.token))
            by_class[entity_class] = _OfClass(
                tuple(slot for slot in mine if slot not in plain),
                plain,
                tuple(role_of(form, slot.path) for slot in plain),
                frozenset(each for each in classes if each != entity_class),
            )
        return cls(canonical_text(form) if slots else "", slots, by_class)


def resolve_slots(
    form: FormSlots, heard: Heard, ontology: Ontology, evidence: Evidence
) -> tuple[Slot, ...]:
    """Return the slots of a form with what an utterance says of them (see ``deanonymize``)."""
    values = _resolve(form, heard, evidence)
    resolved = (values.get(slot.path, slot) for slot in form.slots)
    return tuple(_offer(slot, ontology, heard.phrases) for slot in resolved)


def _resolve(form: FormSlots, heard: Heard, evidence: Evidence) -> dict[SlotPath, Slot]:
    """Return the slots with the values of the mentions that fit them.

    One value for several slots is not certain where an unknown word may be one of them.
    """
    values: dict[SlotPath, Slot] = {}
    for entity_class, mine in form.by_class.items():
        is_said = evidence.has_with_or(form.text, entity_class)
        mentions = heard.mentions(entity_class, None if is_said else mine.other_classes)
        for slot in mine.numbered:
            values[slot.path] = _by_number(slot, heard.spans(entity_class), mentions)
        assigned = assign(form.text, entity_class, mine.roles, mentions, evidence)
        named = tuple(
            dict.fromkeys(
                value for each in mentions for value in each.alternatives or (each.value,)
            )
        )
        is_doubtful = len(mine.plain) > len(named) == 1 and bool(heard.phrases.get(entity_class))
        for slot, choice in zip(mine.plain, assigned, strict=True):
            values[slot.path] = _with_choice(slot, choice, named, is_doubtful)
    return values


def _with_choice(slot: Slot, choice: Choice, named: tuple[str, ...], is_doubtful: bool) -> Slot:
    mention = choice.mention
    if mention is not None and mention.alternatives:
        return _with_alternatives(slot, mention)
    value = mention.value if mention is not None else None
    is_certain = choice.is_certain and not is_doubtful
    value, likely = (value, None) if is_certain else (None, value)
    return Slot(
        slot.path, slot.token, slot.entity_class, named, bool(named), value=value, likely=likely
    )


def _with_alternatives(slot: Slot, mention: Mention) -> Slot:
    """Leave it open which of the values that "or" joins is meant; the one said first is as likely as any."""
    return replace(
        slot,
        candidates=mention.alternatives,
        is_named=True,
        likely=mention.alternatives[0],
        phrases=mention.phrases,
        is_choice=True,
    )


def _by_number(slot: Slot, spans: Sequence[Span], mentions: Sequence[Mention]) -> Slot:
    """Give a numbered token the value of its number: that of the token, or else of the mention."""
    number = slot.token.strip("<>").removeprefix(slot.entity_class)
    if any(_NUMBER.search(span.token) for span in spans):
        spans = [span for span in spans if _NUMBER.findall(span.token) == [number]]
    else:
        spans = spans[int(number) :][:1]
    named = tuple(dict.fromkeys(span.value for span in spans))
    value = named[0] if len(named) == 1 else None
    choice = next((each for each in mentions if value in each.alternatives), None)
    if choice is not None:
        return _with_alternatives(slot, choice)
    return replace(slot, candidates=named, is_named=bool(named), value=value)


def _offer(slot: Slot, ontology: Ontology, phrases: Mapping[str, tuple[str, ...]]) -> Slot:
    """Give an open slot that nobody named the unknown words of the utterance, and the entities of its class."""
    if slot.value is not None or slot.is_named:
        return slot
    known = ontology.texts_of(slot.entity_class)
    words = phrases.get(slot.entity_class, phrases[""])
    return Slot(slot.path, slot.token, slot.entity_class, known, likely=slot.likely, phrases=words)
