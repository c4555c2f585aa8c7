"""Asks the parts of a world's answerer one after the other, to be measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import log
from time import process_time

from annotations.language.errors import Refusal
from annotations.language.grounding import deanonymize
from annotations.models import World
from parser_service.analysis.probabilities import probability_of
from parser_service.analysis.sureness import AnsweredForm, AnsweringPart, Evidence
from parser_service.models import AnsweringOrder, TrainingRun
from parser_service.parsers.interface import UNKNOWN, Candidate, Parser, ScoreKind
from parser_service.serving.default_runs import answering_run
from parser_service.serving.loading import load_parser, make_untrained
from parser_service.serving.parse_answers import Reading, answer_with, form_of
from parser_service.serving.preparing import WorldLanguage

_BEAM = 5


def _log_probability(candidate: Candidate, kind: ScoreKind | None) -> float | None:
    probability = probability_of(candidate.score, kind)
    return None if probability is None else log(max(probability, 1e-30))


@dataclass(frozen=True)
class PartsInOrder:
    """Asks the grammar oracle, and the learned parser of ``run`` where that is silent."""

    order: str
    run: TrainingRun | None
    oracle: Parser | None
    learned: Parser | None
    language: WorldLanguage

    @classmethod
    def of(cls, world: World, order: str) -> PartsInOrder:
        """Return what answers in ``world``. Raises Refusal where nothing can."""
        run = oracle = None
        missing: list[Refusal] = []
        if order != AnsweringOrder.ORACLE:
            try:
                run = answering_run(world)
            except Refusal as error:
                missing.append(error)
        if order != AnsweringOrder.LEARNED:
            try:
                oracle = make_untrained("grammar-oracle", world)
            except Refusal as error:
                missing.append(error)
        if run is None and oracle is None:
            raise missing[0]
        learned = load_parser(run).hesitant() if run else None
        return cls(order, run, oracle, learned, WorldLanguage.of(world))

    def answer(self, utterances: Sequence[str]) -> list[AnsweredForm]:
        return [self._answer(each) for each in utterances]

    def _answer(self, utterance: str) -> AnsweredForm:
        began = process_time()
        for name, parser in (
            (AnsweringPart.ORACLE, self.oracle),
            (AnsweringPart.LEARNED, self.learned),
        ):
            candidates = parser.predict([utterance], _BEAM)[0] if parser else []
            if parser and candidates and candidates[0].form != UNKNOWN:
                return self._judge(name, utterance, candidates, parser.score_kind, began)
        return AnsweredForm(seconds=process_time() - began)

    def _judge(
        self,
        part: AnsweringPart,
        utterance: str,
        candidates: Sequence[Candidate],
        kind: ScoreKind | None,
        began: float,
    ) -> AnsweredForm:
        best, *others = candidates
        form = form_of(best.form)
        if form is None:
            return AnsweredForm(seconds=process_time() - began)
        language = self.language
        heard = language.anonymizer.anonymize(utterance)
        given = deanonymize(form, heard, language.ontology, language.evidence, best.values)
        answer = answer_with(best, given, language, language.lookup)
        _, not_said, left_out, _ = Reading(best, answer, given.slots).misfit(heard)
        own = [_log_probability(each, kind) for each in candidates]
        evidence = Evidence(
            part,
            is_exact=best.score == 0,
            heard_cost=max(-best.score, 0.0),
            readings=1 + sum(each.score == best.score for each in others),
            learned_log_probability=own[0],
            margin=own[0] - own[1]
            if others and own[0] is not None and own[1] is not None
            else None,
            not_said=int(not_said),
            left_out=left_out,
            executable=answer.executable_plans > 0,
        )
        ambiguous = any(slot.is_ambiguous for slot in given.slots)
        seconds = process_time() - began
        return AnsweredForm(
            best.form, evidence, bool(not_said), ambiguous=ambiguous, seconds=seconds
        )
