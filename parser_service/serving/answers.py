"""What a parser answers to an utterance, with the entities that the utterance names."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
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
    deanonymize,
    open_slots_as_json,
)
from annotations.language.ontology import Ontology
from annotations.language.plans import make_plan
from annotations.language.predicates import gloss
from annotations.language.symbols import ENTITY_CLASSES
from parser_service.models import TrainingRun
from parser_service.parsers.interface import Candidate
from parser_service.serving.loading import load_parser
from parser_service.serving.preparing import WorldLanguage, text_for

LEAST_SCORE = -1e300  # in place of −∞, which JSON cannot say
REMEMBERED_FORMS = 4096
MOST_OFFERED = 20


@dataclass(frozen=True, slots=True)
class Answer:
    """One candidate. ``grounded`` names the entities of the utterance, certain and likely ones, and
    ``remarks`` say what stays open; ``open_slots`` ask for it (``grounding.open_slots_as_json``). ``plan``
    is what a robot does (``plans.Plan.as_json``). Where the parser wrote no well-formed form there is
    nothing but ``form`` and ``score``."""

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

    def as_json(self) -> dict[str, Any]:
        """Return plain values, as REST answers them (DESIGN §8)."""
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
        }


@dataclass(frozen=True, slots=True)
class Parse:
    """The answers to an utterance, best first. ``parsed_text`` is what the parser was given; ``remarks``
    say what of it the world does not know."""

    heard: Anonymized
    parsed_text: str
    answers: tuple[Answer, ...]
    remarks: tuple[str, ...] = ()

    @property
    def is_unknown(self) -> bool:
        """Whether there is no form to act on: none, one that is not well-formed, or UNKNOWN."""
        return not self.answers or self.answers[0].is_unknown

    def as_json(self) -> dict[str, Any]:
        """Return plain values, as REST answers them (DESIGN §8)."""
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
                }
                for span in self.heard.spans
            ],
            "parsed_text": self.parsed_text,
            "is_unknown": self.is_unknown,
            "remarks": list(self.remarks),
            "candidates": [answer.as_json() for answer in self.answers],
        }


def parse(run: TrainingRun, utterance: str, beam_width: int = 5) -> Parse:
    """Return the answers of ``run`` to ``utterance``, computed in this process. Raises ValueError where it
    cannot answer."""
    parser = load_parser(run)
    language = WorldLanguage.of(run.world)
    heard = language.anonymizer.anonymize(utterance)
    text = text_for(run, heard)
    return read_answers(heard, text, parser.predict([text], beam_width)[0], language)


def read_answers(
    heard: Anonymized, text: str, candidates: Sequence[Candidate], language: WorldLanguage
) -> Parse:
    """Return what a parser answered to ``text``, with the entities that were heard in its place."""
    answers = (_read(each, heard, language) for each in candidates)
    remarks = tuple(_unknown_tokens(heard.original, language.ontology))
    return Parse(heard, text, tuple(answers), remarks)


def _read(candidate: Candidate, heard: Anonymized, language: WorldLanguage) -> Answer:
    score = max(float(candidate.score), LEAST_SCORE)
    form = _form_of(candidate.form)
    if form is None:
        return Answer(candidate.form, score)
    deanonymized = deanonymize(form, heard, language.ontology, language.evidence)
    grounded = deanonymized.form
    return Answer(
        form=candidate.form,
        score=score,
        is_well_formed=True,
        is_unknown=isinstance(form, Unknown),
        grounded=to_corpus(grounded),
        reading=to_reading(grounded),
        english=gloss(grounded, language.predicates),
        open_slots=tuple(_ask(deanonymized, language)),
        remarks=tuple(dict.fromkeys(_open_slots(deanonymized, language.ontology))),
        plan=make_plan(
            grounded,
            language.ontology,
            language.predicates,
            language.action_names,
            slots=deanonymized.slots,
            lookup=language.lookup,
        ).as_json(),
    )


def _ask(deanonymized: Deanonymized, language: WorldLanguage) -> Iterator[dict[str, Any]]:
    """Yield the open slots, with at most ``MOST_OFFERED`` choices each where the utterance names none."""
    for slot in open_slots_as_json(deanonymized, language.predicates):
        if not slot["is_named"]:
            slot["choices"] = slot["choices"][:MOST_OFFERED]
        yield slot


@lru_cache(maxsize=REMEMBERED_FORMS)
def _form_of(text: str) -> Form | None:
    """Return the form, which parsers answer again and again; None for a text that is none."""
    try:
        return read_form(text)
    except LanguageError:
        return None


def _unknown_tokens(utterance: str, ontology: Ontology) -> Iterator[str]:
    """Yield a sentence for each class token of ``utterance`` that stands for nothing in the world."""
    for token in dict.fromkeys(CLASS_TOKEN.findall(utterance)):
        entity_class = token.rstrip("0123456789")
        if entity_class not in ENTITY_CLASSES:
            known = ", ".join(f"<{name}>" for name in ENTITY_CLASSES)
            yield f"<{token}> is not a class of entities. There are: {known}."
        elif not ontology.of_class(entity_class):
            yield f"<{token}>: this world has no entity of the class {entity_class}."


def _open_slots(deanonymized: Deanonymized, ontology: Ontology) -> Iterator[str]:
    """Yield a sentence for each slot of an answer that no entity fills with certainty."""
    for slot in deanonymized.open_slots:
        if slot.is_ambiguous:
            yield f"{slot.token} stays open: it may be {' or '.join(slot.candidates)}."
        elif slot.entity_class and not ontology.of_class(slot.entity_class):
            yield f"{slot.token} stays open: this world has no entity of the class {slot.entity_class}."
        elif slot.entity_class:
            yield f"{slot.token} stays open: the utterance names no {slot.entity_class} of this world."
