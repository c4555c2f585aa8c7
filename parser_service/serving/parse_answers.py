"""What a parser answers to an utterance, with the entities that the utterance names."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from math import exp, inf
from typing import Any

from annotations.language.errors import LanguageError
from annotations.language.forms import (
    CLASS_TOKEN,
    Form,
    Unknown,
    read_form,
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
from annotations.language.ontology import Ontology
from annotations.language.plans import Lookup, PlanProblem, doubts_about, make_plan
from annotations.language.predicates import gloss
from annotations.language.recipes import TaskPlan, apply_recipes, spoken
from annotations.models import World
from parser_service.models import TrainingRun
from parser_service.parsers.interface import UNKNOWN, Candidate, Parser, ScoreKind
from parser_service.serving.loading import load_parser
from parser_service.serving.preparing import WorldLanguage

LEAST_SCORE = -1e300  # in place of −∞, which JSON cannot say
REMEMBERED_FORMS = 4096
MOST_OFFERED = 20
ABOUT_EQUAL = 0.01  # of a probability or a similarity
_JSON = json.JSONEncoder(ensure_ascii=False, allow_nan=False)


@dataclass(frozen=True, slots=True)
class ParsedCandidate:
    """One candidate. ``grounded`` names the entities of the utterance, certain and likely ones, and
    ``remarks`` say what stays open; ``open_slots`` ask for it (``grounding.open_slots_as_json``). ``plan``
    is what a robot does (``plans.Plan.as_json``), ``task_plan`` the same in its own primitives
    (``recipes.TaskPlan.as_json``), and ``spoken`` says that in a sentence. Where the parser wrote no well-formed
    form there is nothing but ``form`` and ``score``. ``values`` are those of ``Candidate``."""

    form: str
    score: float
    is_well_formed: bool = False
    is_unknown: bool = True
    grounded: str = ""
    reading: str = ""
    english: str = ""
    open_slots: tuple[dict[str, Any], ...] = ()
    remarks: tuple[str, ...] = ()
    plan: dict[str, Any] | None = None
    task_plan: dict[str, Any] | None = None
    spoken: str = ""
    values: tuple[str | None, ...] = ()

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
            "remarks": list(self.remarks),
            "plan": self.plan,
            "task_plan": self.task_plan,
            "spoken": self.spoken,
            "values": list(self.values),
        }


@dataclass(frozen=True, slots=True)
class ParsedUtterance:
    """The answers to an utterance, best first. ``parsed_text`` is what the parser was given; ``remarks``
    say what of it the world does not know, and ``is_cut`` that the parser read only its beginning."""

    heard: Anonymized
    parsed_text: str
    answers: tuple[ParsedCandidate, ...]
    remarks: tuple[str, ...] = ()
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
            "remarks": list(self.remarks),
            "candidates": [answer.as_json() for answer in self.answers],
        }


def parse(run: TrainingRun, utterance: str, beam_width: int = 5) -> ParsedUtterance:
    """Return the answers of ``run`` to ``utterance``, computed in this process. Raises Refusal where it
    cannot answer."""
    return ask(load_parser(run).hesitant(), run.world, utterance, beam_width)


def ask(parser: Parser, world: World, utterance: str, beam_width: int) -> ParsedUtterance:
    """Return the answers of ``parser`` to an utterance in ``world``. Raises Refusal where it cannot answer."""
    language = WorldLanguage.of(world)
    heard = language.anonymizer.anonymize(utterance)
    candidates = parser.predict([utterance], beam_width)[0]
    return read_answers(heard, utterance, candidates, language, parser.score_kind)


def read_answers(
    heard: Anonymized,
    text: str,
    candidates: Sequence[Candidate],
    language: WorldLanguage,
    score_kind: str | None = None,
) -> ParsedUtterance:
    """Return what a parser answered to ``text``, with the entities that were heard in its place."""

    def slots_of(candidate: Candidate) -> tuple[Slot, ...] | None:
        form = form_of(candidate.form)
        return None if form is None else _given(candidate, form, heard, language).slots

    candidates = prefer_grounded(candidates, heard, score_kind, slots_of)
    answers = tuple(answer_of(each, heard, language) for each in candidates)
    remarks = unknown_tokens(heard.original, language.ontology)
    return ParsedUtterance(heard, text, answers, remarks, is_cut_in(candidates))


def prefer_grounded(
    candidates: Sequence[Candidate],
    heard: Anonymized,
    score_kind: str | None,
    slots_of: Callable[[Candidate], Sequence[Slot] | None],
) -> list[Candidate]:
    """Order candidates that are about equally good by how well the entities of the utterance fill them.

    First come those with the fewest slots that no entity fills, then those that leave the fewest of the named entities
    out, then those with the fewest doubtful slots; where that is equal too, the order stays. UNKNOWN keeps its
    place, and so does every candidate that scores clearly otherwise.

    Args:
        score_kind: that of the parser; where scores only order the candidates, equal ones are equally good.
        slots_of: returns the slots of a candidate with their entities; None for a text that is no form.
    """
    ordered: list[Candidate] = []
    for group in _about_equal(candidates, score_kind):
        if len(group) > 1:
            group.sort(key=lambda each: _misfit(slots_of(each), heard))
        ordered += group
    return ordered


def _about_equal(
    candidates: Sequence[Candidate], score_kind: str | None
) -> Iterator[list[Candidate]]:
    """Yield the candidates in groups whose probabilities, or similarities, differ by ``ABOUT_EQUAL`` at most."""
    most = ABOUT_EQUAL if score_kind else 0.0
    group: list[Candidate] = []
    for candidate in candidates:
        is_alone = candidate.form == UNKNOWN or not group or group[0].form == UNKNOWN
        if not is_alone and _share(group[0], score_kind) - _share(candidate, score_kind) <= most:
            group.append(candidate)
            continue
        if group:
            yield group
        group = [candidate]
    if group:
        yield group


def _share(candidate: Candidate, score_kind: str | None) -> float:
    if score_kind == ScoreKind.LOG_PROBABILITY:
        return exp(min(candidate.score, 0.0))
    return candidate.score


def _misfit(slots: Sequence[Slot] | None, heard: Anonymized) -> tuple[float, int, int]:
    """Return how badly the entities of an utterance fit the slots of a form: how many slots have no entity, how
    many entities no slot, and how many slots no certain entity."""
    if slots is None:
        return inf, 0, 0
    put_in = [slot.filler for slot in slots]
    named: Counter[str | None] = Counter(span.value for span in heard.spans)
    left_out = (named - Counter(put_in)).total()
    return put_in.count(None), left_out, sum(slot.value is None for slot in slots)


def is_cut_in(candidates: Sequence[Candidate]) -> bool:
    """Return whether the candidates of an utterance say that the parser read only its beginning."""
    return any(each.is_cut for each in candidates)


def answer_of(candidate: Candidate, heard: Anonymized, language: WorldLanguage) -> ParsedCandidate:
    """Return one candidate with the entities that were heard."""
    form = form_of(candidate.form)
    if form is None:
        return ParsedCandidate(candidate.form, score_of(candidate))
    given = _given(candidate, form, heard, language)
    return answer_with(candidate, given, language, language.lookup)


def _given(
    candidate: Candidate, form: Form, heard: Anonymized, language: WorldLanguage
) -> Deanonymized:
    return deanonymize(form, heard, language.ontology, language.evidence, candidate.values)


def answer_with(
    candidate: Candidate, given: Deanonymized, language: WorldLanguage, lookup: Lookup
) -> ParsedCandidate:
    """Return one well-formed candidate with its entities in it. ``lookup`` finds those of the plan."""
    plan = make_plan(
        given.form,
        language.ontology,
        language.predicates,
        language.action_names,
        slots=given.slots,
        lookup=lookup,
    )
    task_plan = task_plan_of(given.form, doubts_about(given.slots), language, lookup)
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
            language.ontology.class_of_text,
        ),
        open_slots=tuple(questions_of(given, language)),
        remarks=remarks_on(given, language.ontology),
        plan=plan.as_json(),
        task_plan=task_plan.as_json(),
        spoken=spoken(task_plan),
        values=candidate.values,
    )


def task_plan_of(
    form: Form, doubts: Sequence[PlanProblem], language: WorldLanguage, lookup: Lookup | None = None
) -> TaskPlan:
    """Return what the robot of the world does for a form with entities, in its own primitives.

    Args:
        doubts: the problems of entities that are only likely.
        lookup: finds the entities; that of the language by default.
    """
    # Recipes know the arguments by the names that the language gives them, whatever the robot calls them.
    plan = make_plan(form, language.ontology, language.predicates, lookup=lookup or language.lookup)
    plan = replace(plan, problems=(*doubts, *plan.problems))
    return apply_recipes(plan, language.recipes, language.usual)


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


@lru_cache(maxsize=REMEMBERED_FORMS)
def form_of(text: str) -> Form | None:
    """Return the form, which parsers answer again and again; None for a text that is none."""
    try:
        return read_form(text)
    except LanguageError:
        return None


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


def remarks_on(given: Deanonymized, ontology: Ontology) -> tuple[str, ...]:
    """Return a sentence for each slot of an answer that no entity fills with certainty, each once."""
    sentences = []
    for slot in given.open_slots:
        if slot.is_ambiguous:
            why = f"it may be {' or '.join(slot.candidates)}"
        elif not slot.entity_class:
            continue
        elif ontology.of_class(slot.entity_class):
            why = f"the utterance names no {slot.entity_class} of this world"
        else:
            why = f"this world has no entity of the class {slot.entity_class}"
        sentences.append(f"{slot.token} stays open: {why}.")
    return tuple(dict.fromkeys(sentences))
