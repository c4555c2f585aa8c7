"""Write answers as JSON, with the outlines of their forms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from annotations.language.forms import Form, Unknown
from annotations.language.grounding import (
    Anonymized,
    Deanonymized,
    Slot,
    UtteranceMentions,
    fill_all,
    is_asked_plainly,
    named_entities,
    resolve_slots,
    with_values,
)
from annotations.language.texts import MOST_STAND_INS, stand_in
from annotations.language.world import ask_for
from parser_service.parsers.interface import Candidate
from parser_service.parsers.remembering import remembered
from parser_service.serving.outlines import (
    Outline,
    Outlines,
    Paths,
    StandIn,
    name_of_entity,
)
from parser_service.serving.parse_answers import (
    ParsedCandidate,
    Reading,
    answer_with,
    as_json,
    best_first,
    form_of,
    questions_of,
    score_of,
    warnings_about,
)
from parser_service.serving.preparing import WorldLanguage

Slots = tuple[Slot, ...]
Written = tuple[str, int]  # the JSON of a candidate, and how many of its plans are executable
# That no outline says. An utterance is looked at again to find its commands.
REMEMBERED_ANSWERS = 1024
_SIGNS = tuple((stand_in(n), stand_in(n, is_plural=True)) for n in range(MOST_STAND_INS))


class AnswerWriter:
    """Writes the candidates of ``parse_answers.read_answers(…).as_json()``, character for character.

    What depends on the form alone is made once for each form; an utterance puts its entities into it. Where an
    outline cannot say an answer, the answer is made by itself. Several threads may write.
    """

    def __init__(self, language: WorldLanguage) -> None:
        self.language = language
        self._outlines = Outlines(language)

    def readings(
        self,
        heard: Anonymized,
        candidates: Sequence[Candidate],
        score_kind: str | None,
        utterance: str | None = None,
    ) -> list[Reading[str]]:
        """Return the readings of the candidates for what was heard, best first; each with its answer as JSON.

        ``utterance`` is what was said, where something else was heard.
        """
        mentions = UtteranceMentions(heard, self.language.ontology)
        said = heard.original if utterance is None else utterance
        readings = [self._write(each, mentions, said) for each in candidates]
        return best_first(readings, heard, score_kind)

    def _write(
        self, candidate: Candidate, heard: UtteranceMentions, utterance: str
    ) -> Reading[str]:
        form = form_of(candidate.form)
        if form is None:
            answer = ParsedCandidate(candidate.form, score_of(candidate))
            return Reading(candidate, lambda: (as_json(answer.as_json()), 0))
        slots = self._slots(candidate, heard)

        def write() -> Written:
            filled_in = self._fill(candidate, form, slots, utterance)
            return filled_in or self._write_anew(candidate, slots, utterance)

        return Reading(candidate, write, slots)

    def _write_anew(self, candidate: Candidate, slots: Slots, utterance: str) -> Written:
        made = self._answer(candidate.form, candidate.values, slots, utterance)
        answer = replace(made, score=score_of(candidate))
        return as_json(answer.as_json()), answer.executable_plans

    @remembered(REMEMBERED_ANSWERS)
    def _answer(
        self, text: str, values: tuple[str | None, ...], slots: Slots, utterance: str
    ) -> ParsedCandidate:
        """Return the answer with the form that ``text`` says, without its score."""
        form, language = form_of(text), self.language
        assert form is not None
        given = fill_all(form, slots)
        return answer_with(
            Candidate(text, 0.0, values=values), given, language, language.lookup, utterance
        )

    def _slots(self, candidate: Candidate, heard: UtteranceMentions) -> Slots:
        """Return the slots of a form with their entities."""
        slots = self._outlines.slots(candidate.form)
        language = self.language
        resolved = resolve_slots(slots, heard, language.ontology, language.evidence)
        return with_values(resolved, candidate.values)

    def _fill(
        self, candidate: Candidate, form: Form, slots: Slots, utterance: str
    ) -> Written | None:
        """Return the outline with its entities; None where it would say something else."""
        if isinstance(form, Unknown):
            return None  # the plan asks about this utterance
        if not all(slot.value is not None or is_asked_plainly(slot) for slot in slots):
            return None  # the plan asks for it in words of this utterance, or names a guess
        put_in = [(slot.path, value) for slot in slots if (value := slot.filler) is not None]
        if len({value.casefold() for _, value in put_in}) < len(put_in):
            return None  # who is named twice is one person
        paths = tuple(path for path, _ in put_in)
        texts = [text for _, value in put_in if (text := self._outlines.text(value))]
        asked = self._outlines.asked(candidate.form, paths)
        if len(texts) < len(paths) or asked is None:
            return None
        found = [self._outlines.entity(texts[e.number].text, e.predicate, e.place) for e in asked]
        entities = [each for each in found if each is not None]
        if len(entities) < len(asked):
            return None
        classes = tuple(entity_class for entity_class, _ in entities)
        put_in_classes = tuple(each.entity_class for each in texts)
        outline = self._outlines.answer(candidate.form, paths, put_in_classes, classes)
        if outline is None or outline.is_right is False:
            return None
        own, executable_plans = self._own_values(outline, candidate, form, slots, paths, texts)
        filled_in = outline.fill(
            {name_of_entity(number): text for number, (_, text) in enumerate(entities)}
            | {
                sign: text
                for signs, each in zip(_SIGNS, texts, strict=False)
                for sign, text in zip(signs, (each.in_json, each.plural_in_json), strict=True)
            }
            | own
        )
        written = filled_in, executable_plans
        if outline.is_right is None:
            outline.is_right = written == self._write_anew(candidate, slots, utterance)
        return written if outline.is_right else None

    def _own_values(
        self,
        outline: Outline,
        candidate: Candidate,
        form: Form,
        slots: Slots,
        paths: Paths,
        texts: Sequence[StandIn],
    ) -> tuple[dict[str, str], int]:
        """Return the JSON of the values that differ between answers with one outline, by their names, and how many of
        the two plans a robot can carry out."""
        plain = {
            sign: text
            for signs, each in zip(_SIGNS, texts, strict=False)
            for sign, text in zip(signs, (each.text, each.plural), strict=True)
        }

        named = named_entities(slots)

        def asked_for(slot: Slot) -> str:
            asked = self._outlines.question(candidate.form, paths, slot.path)
            if asked is not None:
                return asked.fill(plain)
            language = self.language
            filled = fill_all(form, slots).form
            return ask_for(
                filled,
                slot.path,
                slot.entity_class,
                language.predicates,
                language.ontology.classes,
                named,
            )

        given = Deanonymized(form, slots)
        put_in = tuple(each.text for each in texts)
        task_plan = self._outlines.task_plan(candidate.form, paths, put_in)
        values = {
            "task_plan": task_plan.text,
            "spoken": task_plan.spoken,
            "score": as_json(score_of(candidate)),
            "values": as_json(list(candidate.values)),
            "open_slots": as_json(list(questions_of(given, self.language, asked_for))),
            "warnings": as_json(warnings_about(given, self.language.ontology)),
        }
        return values, outline.is_executable + task_plan.is_executable
