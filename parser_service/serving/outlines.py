"""What of an answer depends on the form and not on the utterance: made once, with places for the entities.

An outline is the JSON of an answer with signs in place of its entities (``english.stand_in``). It is made by
the very functions that make an answer, from a form with signs in place of its class tokens.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from annotations.language.forms import Form, Reference, walk
from annotations.language.grounding import Deanonymized, FormSlots, SlotPath, filled
from annotations.language.plans import Lookup, Named, Value, Words, spoken
from annotations.language.texts import MOST_STAND_INS, STAND_IN, plural, read_stand_in, stand_in
from annotations.language.world import ask_for, can_stand_in, is_loose, texts_of_patterns
from parser_service.parsers.interface import Candidate
from parser_service.parsers.remembering import remembered
from parser_service.serving.parse_answers import answer_with, as_json, form_of, task_plan_of
from parser_service.serving.preparing import WorldLanguage

REMEMBERED = 4096  # of each kind of thing that is made once
OWN = ("score", "open_slots", "warnings", "values", "task_plan", "spoken")  # of each answer
_AWAITED = "awaited"
_PLACE = re.compile(rf'({STAND_IN.pattern}|\{{"{_AWAITED}": "[^"]*"\}})')

Paths = tuple[SlotPath, ...]


class Outline:
    """A text with named places: signs, and values of JSON.

    ``is_executable`` is that of every plan that is made with it. ``is_right`` is None until an answer made with it was
    compared.
    """

    __slots__ = ("_names", "_pieces", "is_executable", "is_right")

    def __init__(self, text: str, plan: Mapping[str, Any] | None = None) -> None:
        parts = _PLACE.split(text)
        self._pieces = parts[0::2]
        self._names = [n if len(n) == 1 else json.loads(n)[_AWAITED] for n in parts[1::2]]
        self.is_executable = bool(plan and plan["is_executable"])
        self.is_right: bool | None = None

    def fill(self, values: Mapping[str, str]) -> str:
        """Return the text with a value in each place."""
        parts = [""] * (2 * len(self._pieces) - 1)
        parts[0::2] = self._pieces
        parts[1::2] = [values[name] for name in self._names]
        return "".join(parts)


@dataclass(frozen=True, slots=True)
class StandIn:
    """What is put in place of a sign, and of that for the plural; each also as it stands in JSON."""

    entity_class: str
    text: str
    plural: str
    in_json: str
    plural_in_json: str


@dataclass(frozen=True, slots=True)
class AskedEntity:
    """An entity that a plan asks for: the number of its text, and the place of a predicate that it takes."""

    number: int
    predicate: str
    place: int


@dataclass(frozen=True, slots=True)
class WrittenTaskPlan:
    """A task plan and the sentence about it, as JSON, and whether a robot can do it without asking anybody."""

    text: str
    spoken: str
    is_executable: bool


class Outlines:
    """Makes the outlines of the forms of a world, and what is put into them, and remembers both.

    A form is named by its text, and ``paths`` lead to its slots that an entity fills, in order. What cannot be said by
    an outline is None.
    """

    def __init__(self, language: WorldLanguage) -> None:
        self.language = language
        self._of_patterns = texts_of_patterns(language.predicates)

    @remembered(REMEMBERED)
    def slots(self, form: str) -> FormSlots:
        """Return the slots of a form."""
        return FormSlots.of(_read(form))

    @remembered(REMEMBERED)
    def text(self, text: str) -> StandIn | None:
        """Return what is put in for a text; one of two classes may be said in another way than others of its slot."""
        entity_class = self.language.ontology.class_of_text.get(text)
        if entity_class is None or not can_stand_in(text, self._of_patterns):
            return None
        many = plural(text)
        return StandIn(entity_class, text, many, as_json(text)[1:-1], as_json(many)[1:-1])

    @remembered(REMEMBERED)
    def entity(self, text: str, predicate: str, place: int) -> tuple[str, str] | None:
        """Return class and JSON of an entity that a plan asks for; the class is empty for mere words."""
        value, is_missing = self.language.lookup.value(text, predicate, place)
        if is_missing:
            return None
        entity_class = value.entity_class if isinstance(value, Named) else ""
        return entity_class, as_json(value.as_json())

    @remembered(REMEMBERED)
    def asked(self, form: str, paths: Paths) -> tuple[AskedEntity, ...] | None:
        """Return what the plan of a form asks for, whatever entities fill it."""
        if len(paths) > MOST_STAND_INS or STAND_IN.search(form):
            return None
        return tuple(self._make(form, paths, (), {})[1])

    @remembered(REMEMBERED)
    def answer(
        self, form: str, paths: Paths, put_in: tuple[str, ...], classes: tuple[str, ...]
    ) -> Outline | None:
        """Return the outline of an answer. ``put_in`` are the classes of the texts at ``paths``, since things are in a
        room and at a location; ``classes`` are those of what was ``asked`` for."""
        # What stands for something said before depends on what is put in there.
        if any(isinstance(each, Reference) for each in walk(_read(form))):
            return None
        asked = self.asked(form, paths) or ()
        answer, _ = self._make(form, paths, put_in, dict(zip(asked, classes, strict=True)))
        own = {name: _await(name) for name in OWN}
        text = as_json(answer | own)
        return Outline(text, answer["plan"]) if _is_sound(text, paths) else None

    @remembered(REMEMBERED)
    def task_plan(self, form: str, paths: Paths, texts: tuple[str, ...]) -> WrittenTaskPlan:
        """Return the task plan of a form with entities in it, and the sentence about it, as JSON.

        No outline says them: which steps there are depends on which entities are the same.
        """
        grounded = _read(form)
        for path, text in zip(paths, texts, strict=True):
            grounded = filled(grounded, path, text)
        made = task_plan_of(grounded, self.language)
        return WrittenTaskPlan(as_json(made.as_json()), as_json(spoken(made)), made.is_executable)

    @remembered(REMEMBERED)
    def question(self, form: str, paths: Paths, asked: SlotPath) -> Outline | None:
        """Return the outline of the question for the slot at ``asked``."""
        classes = {slot.path: slot.entity_class for slot in self.slots(form).slots}
        named = {stand_in(number): classes[path] for number, path in enumerate(paths)}
        language = self.language
        text = ask_for(
            _with_signs(form, paths),
            asked,
            classes[asked],
            language.predicates,
            language.ontology.classes,
            {sign: entity_class for sign, entity_class in named.items() if entity_class},
        )
        return Outline(text) if _is_sound(text, paths) else None

    def _make(
        self,
        form: str,
        paths: Paths,
        put_in: tuple[str, ...],
        classes: Mapping[AskedEntity, str],
    ) -> tuple[dict[str, Any], Mapping[AskedEntity, str]]:
        """Return the answer with signs, and what its plan asks for with the names of these places."""
        class_of_sign = {stand_in(number): each for number, each in enumerate(put_in)}
        lookup = _AwaitingLookup(self.language.lookup, classes, class_of_sign)
        given = Deanonymized(_with_signs(form, paths), ())
        answer = answer_with(Candidate(form, 0.0), given, self.language, lookup)
        return answer.as_json(), lookup.names


class _AwaitingLookup(Lookup):
    """Gives a place for the entity of a sign. ``names`` are those of the places, in the order of asking."""

    def __init__(
        self, lookup: Lookup, classes: Mapping[AskedEntity, str], class_of_sign: Mapping[str, str]
    ) -> None:
        self._lookup = lookup
        self.classes = lookup.classes
        self.class_of_text = {**lookup.class_of_text, **class_of_sign}
        self._class_of = classes
        self.names: dict[AskedEntity, str] = {}

    def value(self, text: str, predicate: str, place: int) -> tuple[Value, bool]:
        if not STAND_IN.fullmatch(text):
            return self._lookup.value(text, predicate, place)
        asked = AskedEntity(read_stand_in(text)[0], predicate, place)
        name = self.names.setdefault(asked, name_of_entity(len(self.names)))
        entity_class = self._class_of.get(asked, "")
        awaited = _AwaitedNamed(entity_class, name) if entity_class else _AwaitedWords(name)
        return awaited, False

    def places_called(self, text: str) -> tuple[Named, ...]:
        return self._lookup.places_called(text)


class _AwaitedNamed(Named):
    """Stands for an entity whose text is the name of its place."""

    def as_json(self) -> dict[str, Any]:
        return _await(self.text)


class _AwaitedWords(Words):
    """Stands for words; their text is the name of their place."""

    def as_json(self) -> dict[str, Any]:
        return _await(self.text)


def name_of_entity(number: int) -> str:
    """Return the name of the place of what a plan asks for."""
    return f"entity {number}"


def _await(name: str) -> dict[str, Any]:
    """Return what is in an outline in place of a value of JSON."""
    return {_AWAITED: name}


def _read(text: str) -> Form:
    form = form_of(text)
    assert form is not None
    return form


def _with_signs(text: str, paths: Paths) -> Form:
    form = _read(text)
    for number, path in enumerate(paths):
        form = filled(form, path, stand_in(number))
    return form


def _is_sound(text: str, paths: Paths) -> bool:
    """Return whether a text has no signs but those of its own, and each is a word."""
    numbers = {read_stand_in(sign)[0] for sign in STAND_IN.findall(text)}
    return is_loose(text) and all(number < len(paths) for number in numbers)
