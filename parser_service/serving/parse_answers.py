"""What a parser answers to an utterance, with the entities that the utterance names."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache, partial
from math import exp, inf
from typing import Any, Generic, TypeVar

from annotations.language.forms import (
    CLASS_TOKEN,
    Form,
    Unknown,
    read_or_none,
    to_corpus,
    to_reading,
)
from annotations.language.grounding import (
    Anonymized,
    Deanonymized,
    Slot,
    deanonymize,
    open_slots_as_json,
)
from annotations.language.plans import Lookup, TaskPlan, TaskValue, apply_recipes, make_plan, spoken
from annotations.language.world import Ontology, gloss
from parser_service.parsers.interface import UNKNOWN, Candidate, ScoreKind
from parser_service.serving.preparing import WorldLanguage

LEAST_SCORE = -1e300  # in place of −∞, which JSON cannot say
REMEMBERED_FORMS = 4096
MOST_OFFERED = 20
ABOUT_EQUAL = 0.01  # of a probability or a similarity
PLANS = 2  # of a candidate: ``plan`` and ``task_plan``
T = TypeVar("T")  # an answer: as a value, or as JSON
_JSON = json.JSONEncoder(ensure_ascii=False, allow_nan=False)


@dataclass(frozen=True, slots=True)
class ParsedCandidate:
    """One candidate. ``grounded`` names the entities of the utterance, certain and likely ones, and
    ``warnings`` say what stays open; ``open_slots`` ask for it (``open_slots_as_json``). ``plan``
    is what a robot does (``Plan.as_json``), ``task_plan`` the same in its own primitives
    (``TaskPlan.as_json``), and ``spoken`` says that in a sentence. Where the parser wrote no well-formed
    form there is nothing but ``form`` and ``score``. ``values`` are those of ``Candidate``."""

    form: str
    score: float
    is_well_formed: bool = False
    is_unknown: bool = True
    grounded: str = ""
    reading: str = ""
    english: str = ""
    open_slots: tuple[dict[str, Any], ...] = ()
    warnings: tuple[str, ...] = ()
    plan: dict[str, Any] | None = None
    task_plan: dict[str, Any] | None = None
    spoken: str = ""
    values: tuple[str | None, ...] = ()

    @property
    def executable_plans(self) -> int:
        """How many of the two plans a robot can carry out."""
        return sum(bool(each and each["is_executable"]) for each in (self.plan, self.task_plan))

    def as_json(self) -> dict[str, Any]:
        """Return plain values, as REST answers them (docs/reference/parse-server.md)."""
        return {
            "form": self.form,
            "grounded": self.grounded,
            "score": self.score,
            "is_well_formed": self.is_well_formed,
            "reading": self.reading,
            "english": self.english,
            "open_slots": list(self.open_slots),
            "warnings": list(self.warnings),
            "plan": self.plan,
            "task_plan": self.task_plan,
            "spoken": self.spoken,
            "values": list(self.values),
        }


@dataclass(frozen=True, slots=True)
class ParsedUtterance:
    """The answers to an utterance, best first. ``parsed_text`` is what the parser was given; ``warnings``
    say what of it the world does not know, and ``is_cut`` that the parser read only its beginning."""

    heard: Anonymized
    parsed_text: str
    answers: tuple[ParsedCandidate, ...]
    warnings: tuple[str, ...] = ()
    is_cut: bool = False

    @property
    def is_unknown(self) -> bool:
        """Whether there is no form to act on: none, one that is not well-formed, or UNKNOWN."""
        return not self.answers or self.answers[0].is_unknown

    def as_json(self) -> dict[str, Any]:
        """Return plain values, as REST answers them (docs/reference/parse-server.md)."""
        return {
            "utterance": self.heard.original,
            "anonymized": self.heard.command,
            "spans": [
                {
                    "start": span.start,
                    "end": span.end,
                    "text": self.heard.original[span.start : span.end],
                    "token": span.token,
                    "entity_class": span.entity_class,
                    "value": span.value,
                    "likeness": span.likeness.name.lower(),
                }
                for span in self.heard.spans
            ],
            "parsed_text": self.parsed_text,
            "is_unknown": self.is_unknown,
            "is_cut": self.is_cut,
            "warnings": list(self.warnings),
            "candidates": [answer.as_json() for answer in self.answers],
        }


def read_answers(
    heard: Anonymized,
    text: str,
    candidates: Sequence[Candidate],
    language: WorldLanguage,
    score_kind: str | None = None,
) -> ParsedUtterance:
    """Return what a parser answered to ``text``, with the entities that were heard in its place."""

    readings = [_read(each, heard, language) for each in candidates]
    answers = tuple(each.answer for each in best_first(readings, heard, score_kind))
    warnings = unknown_tokens(heard.original, language.ontology)
    return ParsedUtterance(heard, text, answers, warnings, is_cut_in(candidates))


@dataclass(frozen=True)
class Reading(Generic[T]):
    """One candidate with what it is answered with, and what decides its place among those that are equally good.

    ``write`` returns the answer and its ``executable_plans``. It is called when somebody first asks for either: most
    readings only decide which one is answered. ``slots`` are those of the form with their entities, None for a text
    that is no form.
    """

    candidate: Candidate
    write: Callable[[], tuple[T, int]] = field(compare=False)
    slots: Sequence[Slot] | None = None

    @property
    def answer(self) -> T:
        return self._written[0]

    @property
    def executable_plans(self) -> int:
        """How many of the two plans, ``plan`` and ``task_plan``, a robot can carry out without asking anybody."""
        return self._written[1]

    @cached_property
    def _written(self) -> tuple[T, int]:
        return self.write()

    def misfit(self, heard: Anonymized) -> tuple[int, float, int, int]:
        """Return how badly it fits the utterance: how many of its plans cannot be carried out, how many slots have no
        entity, how many entities no slot, and how many slots no certain entity."""
        if self.slots is None:
            return PLANS, inf, 0, 0
        put_in = [slot.filler for slot in self.slots]
        named: Counter[str | None] = Counter(span.value for span in heard.spans)
        left_out = (named - Counter(put_in)).total()
        doubtful = sum(slot.value is None for slot in self.slots)
        return PLANS - self.executable_plans, put_in.count(None), left_out, doubtful


def best_first(
    readings: Sequence[Reading[T]], heard: Anonymized, score_kind: str | None
) -> list[Reading[T]]:
    """Order readings that are about equally good by what a robot can do with them.

    First come those that it can carry out, then those with the fewest slots that no entity fills, then those that leave
    the fewest of the named entities out, then those with the fewest doubtful slots; where that is equal too, the order
    stays. UNKNOWN keeps its place, and so does every candidate that scores clearly otherwise.

    Args:
        score_kind: that of the parser; where scores only order the candidates, equal ones are equally good.
    """
    ordered: list[Reading[T]] = []
    for group in _about_equal(readings, score_kind):
        # One alone is not written to be put in order.
        ordered += sorted(group, key=lambda each: each.misfit(heard)) if group[1:] else group
    return ordered


def _about_equal(
    readings: Sequence[Reading[T]], score_kind: str | None
) -> Iterator[list[Reading[T]]]:
    """Yield the readings in groups whose probabilities, or similarities, differ by ``ABOUT_EQUAL`` at most."""
    most = ABOUT_EQUAL if score_kind else 0.0
    group: list[Reading[T]] = []
    for reading in readings:
        forms = {reading.candidate.form, *(each.candidate.form for each in group[:1])}
        is_alone = not group or UNKNOWN in forms
        if not is_alone and _share(group[0], score_kind) - _share(reading, score_kind) <= most:
            group.append(reading)
            continue
        if group:
            yield group
        group = [reading]
    if group:
        yield group


def _share(reading: Reading[T], score_kind: str | None) -> float:
    score = reading.candidate.score
    return exp(min(score, 0.0)) if score_kind == ScoreKind.LOG_PROBABILITY else score


def is_cut_in(candidates: Sequence[Candidate]) -> bool:
    """Return whether the candidates of an utterance say that the parser read only its beginning."""
    return any(each.is_cut for each in candidates)


def _read(
    candidate: Candidate, heard: Anonymized, language: WorldLanguage
) -> Reading[ParsedCandidate]:
    """Return one candidate with the entities that were heard."""
    form = form_of(candidate.form)
    if form is None:
        answer = ParsedCandidate(candidate.form, score_of(candidate))
        return Reading(candidate, lambda: (answer, 0))
    given = deanonymize(form, heard, language.ontology, language.evidence, candidate.values)

    def write() -> tuple[ParsedCandidate, int]:
        answer = answer_with(candidate, given, language, language.lookup, heard.original)
        return answer, answer.executable_plans

    return Reading(candidate, write, given.slots)


def answer_with(
    candidate: Candidate,
    given: Deanonymized,
    language: WorldLanguage,
    lookup: Lookup,
    utterance: str = "",
) -> ParsedCandidate:
    """Return one well-formed candidate with its entities in it.

    Args:
        lookup: finds the entities of the plan.
        utterance: what was said; the plan tells where it has the words that name nothing.
    """
    make = partial(
        make_plan,
        given.form,
        language.ontology,
        language.predicates,
        slots=given.slots,
        lookup=lookup,
        utterance=utterance,
    )
    plan = make()
    task_plan = apply_recipes(plan, language.recipes, language.usual)
    if not language.action_names.keys().isdisjoint(each.predicate for each in plan.steps):
        plan = make(action_names=language.action_names)
    return ParsedCandidate(
        form=candidate.form,
        score=score_of(candidate),
        is_well_formed=True,
        is_unknown=isinstance(given.form, Unknown),
        grounded=to_corpus(given.form),
        reading=to_reading(given.form),
        english=gloss(
            given.form,
            language.predicates,
            language.ontology.classes,
            lookup.class_of_text,
        ),
        open_slots=tuple(questions_of(given, language)),
        warnings=warnings_about(given, language.ontology),
        plan=plan.as_json(),
        task_plan=task_plan.as_json(),
        spoken=spoken(task_plan),
        values=candidate.values,
    )


def task_plan_of(
    form: Form,
    language: WorldLanguage,
    slots: Sequence[Slot] = (),
    utterance: str = "",
    lookup: Lookup | None = None,
    sent_to: TaskValue | None = None,
) -> TaskPlan:
    """Return what the robot of the world does for a form with entities, in its own primitives.

    Args:
        slots: those of the form, so that the plan asks for the open ones as a dialogue does.
        utterance: what was said.
        lookup: finds the entities; that of the language by default.
        sent_to: where the command before has sent the robot.
    """
    # Recipes know the arguments by the names that the language gives them, whatever the robot calls them.
    plan = make_plan(
        form,
        language.ontology,
        language.predicates,
        slots=slots,
        lookup=lookup or language.lookup,
        utterance=utterance,
    )
    return apply_recipes(plan, language.recipes, language.usual, sent_to)


def as_json(value: object) -> str:
    """Return the JSON of a value as it is sent. Raises ValueError for a number that JSON cannot say."""
    return _JSON.encode(value)


def score_of(candidate: Candidate) -> float:
    """Return the score of a candidate as a number that JSON can say."""
    return max(float(candidate.score), LEAST_SCORE)


def questions_of(
    given: Deanonymized, language: WorldLanguage, asked_for: Callable[[Slot], str] | None = None
) -> Iterator[dict[str, Any]]:
    """Yield the open slots, with at most ``MOST_OFFERED`` choices each where the utterance names none."""
    for slot in open_slots_as_json(
        given, language.predicates, asked_for, language.ontology.classes
    ):
        if not slot["is_named"]:
            slot["choices"] = slot["choices"][:MOST_OFFERED]
        yield slot


form_of = lru_cache(maxsize=REMEMBERED_FORMS)(read_or_none)  # parsers answer a form again and again


def unknown_tokens(utterance: str, ontology: Ontology) -> tuple[str, ...]:
    """Return a sentence for each class token of ``utterance`` that stands for nothing in the world."""
    sentences = []
    for token in dict.fromkeys(CLASS_TOKEN.findall(utterance)):
        entity_class = token.rstrip("0123456789")
        if entity_class not in ontology.classes:
            known = ", ".join(f"<{name}>" for name in ontology.classes.tokens)
            sentences.append(f"<{token}> is not a class of entities. There are: {known}.")
        elif not ontology.of_class(entity_class):
            sentences.append(f"<{token}>: this world has no entity of the class {entity_class}.")
    return tuple(sentences)


def warnings_about(given: Deanonymized, ontology: Ontology) -> tuple[str, ...]:
    """Return a sentence for each slot of an answer that no entity fills with certainty, each once."""
    sentences = []
    for slot in given.open_slots:
        if slot.is_ambiguous:
            why = f"it may be {' or '.join(slot.candidates)}"
        elif not slot.entity_class:
            continue
        elif ontology.of_class(slot.entity_class):
            why = f"the utterance names no {ontology.classes.noun(slot.entity_class)} of this world"
        else:
            why = f"this world has no entity of the class {slot.entity_class}"
        sentences.append(f"{slot.token} stays open: {why}.")
    return tuple(dict.fromkeys(sentences))
