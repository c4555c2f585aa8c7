"""Replace class tokens of a form with the entities that the utterance names (Walker et al. 2019, §3.3)."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from annotations.language.forms import (
    Constant,
    Form,
    Unknown,
    canonical_text,
    children,
    with_part,
)
from annotations.language.grounding.anonymizer import Anonymized, Span
from annotations.language.grounding.assignment import Mention, SlotChoice, assign
from annotations.language.grounding.role_evidence import Evidence, default_evidence
from annotations.language.grounding.roles import SlotPath, SlotRole, role_of
from annotations.language.grounding.utterance_mentions import UtteranceMentions
from annotations.language.world import Ontology

_CLASS_TOKEN = re.compile(r"<\w+>")
_NUMBER = re.compile(r"(?<!\d)\d+(?=>?$)")


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

    @property
    def filler(self) -> str | None:
        """What is put in: the certain value, else the likely one; None where there is neither."""
        return self.value if self.value is not None else self.likely


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
    form: Form,
    anonymized: Anonymized,
    ontology: Ontology,
    evidence: Evidence | None = None,
    values: Sequence[str | None] = (),
) -> Deanonymized:
    """Put the entities of an utterance back into the form that a parser gave for it.

    A numbered token takes the value of its number. Where the utterance names one value of a class,
    and not fewer times than the form has slots of it, it fills them. Several values get the most
    likely assignment by ``evidence`` (of English alone if there is none). A slot stays open, with a likely
    value, if the evidence does not decide which value it gets, or if the utterance joins several by "or"
    and the grammar does not have this form with an "or".

    ``values`` are the entities of the class tokens, in order, where the parser itself says them: these are certain.
    """
    known = evidence or default_evidence()
    heard = UtteranceMentions(anonymized, ontology)
    slots = resolve_slots(FormSlots.of(form), heard, ontology, known)
    return fill_all(form, with_values(slots, values))


def with_values(slots: tuple[Slot, ...], values: Sequence[str | None]) -> tuple[Slot, ...]:
    """Return the slots with the entities that a parser says for the class tokens of its form, in order."""
    said = iter(values)
    return tuple(
        replace(slot, candidates=(value,), is_named=True, value=value, likely=None, is_choice=False)
        if slot.entity_class and (value := next(said, None)) is not None
        else slot
        for slot in slots
    )


def fill_all(form: Form, slots: tuple[Slot, ...]) -> Deanonymized:
    """Return the form with the certain and the likely values of the slots."""
    for slot in slots:
        if slot.filler is not None:
            form = filled(form, slot.path, slot.filler)
    return Deanonymized(form, slots)


def filled(form: Form, path: SlotPath, value: str) -> Form:
    """Return the form with a constant at a path."""
    return with_part(form, path, Constant(value))


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
    roles: tuple[SlotRole, ...]
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
    form: FormSlots, heard: UtteranceMentions, ontology: Ontology, evidence: Evidence
) -> tuple[Slot, ...]:
    """Return the slots of a form with what an utterance says of them (see ``deanonymize``)."""
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
        # One value for several slots is not certain where an unknown word may be one of them.
        is_doubtful = len(mine.plain) > len(named) == 1 and bool(heard.phrases.get(entity_class))
        for slot, choice in zip(mine.plain, assigned, strict=True):
            values[slot.path] = _with_choice(slot, choice, named, is_doubtful)
    resolved: list[Slot] = []
    for slot in form.slots:
        slot = values.get(slot.path, slot)
        if slot.value is None and not slot.is_named:
            # Nobody named it: it may be any entity of its class, or words that nothing explains.
            known = ontology.texts_of(slot.entity_class)
            words = heard.phrases.get(slot.entity_class, heard.phrases[""])
            slot = Slot(
                slot.path, slot.token, slot.entity_class, known, likely=slot.likely, phrases=words
            )
        resolved.append(slot)
    return tuple(resolved)


def _with_choice(slot: Slot, choice: SlotChoice, named: tuple[str, ...], is_doubtful: bool) -> Slot:
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


def ground_like(form: Form, label: Form, grounded: Form) -> Form:
    """Return ``form`` with the entities that ``grounded`` has where ``label`` has class tokens.

    The entities of a class are certain where ``label`` names only one, or where both forms have as many
    tokens of the class: then they keep their order. The other tokens stay as they are.
    """
    known: dict[str, list[str]] = defaultdict(list)
    for entity_class, text in entities_of(label, grounded):
        known[entity_class].append(text)
    slots = [slot for slot in slots_of(form) if slot.entity_class]
    for entity_class, entities in known.items():
        places = [slot.path for slot in slots if slot.entity_class == entity_class]
        if len(set(entities)) == 1:
            entities = entities[:1] * len(places)
        if len(places) == len(entities):
            for path, entity in zip(places, entities, strict=True):
                form = filled(form, path, entity)
    return form


def entities_of(label: Form, grounded: Form) -> list[tuple[str, str]]:
    """Return class and text of what ``grounded`` has in the place of each class token of ``label``, in order."""
    texts = ((slot.entity_class, _text_at(grounded, slot)) for slot in slots_of(label))
    return [(entity_class, text) for entity_class, text in texts if text]


def ground_text(text: str, label: Form, grounded: Form) -> str:
    """Return ``text`` with the entities that ``grounded`` has where ``label`` has the same class tokens.

    Several tokens of one kind take theirs in order; those beyond the last one take the last. Tokens that
    ``label`` does not have stay as they are.
    """
    known: dict[str, list[str]] = defaultdict(list)
    for slot in slots_of(label):
        if entity := _text_at(grounded, slot):
            known[slot.token].append(entity)

    def fill(match: re.Match[str]) -> str:
        entities = known.get(match[0])
        if not entities:
            return match[0]
        return entities.pop(0) if len(entities) > 1 else entities[0]

    return _CLASS_TOKEN.sub(fill, text)


def _text_at(form: Form, slot: Slot) -> str:
    """Return the text of the constant in the place of ``slot``; empty where there is none."""
    for place in slot.path:
        parts = children(form)
        if place >= len(parts):
            return ""
        form = parts[place]
    return str(form.value) if isinstance(form, Constant) and slot.entity_class else ""
