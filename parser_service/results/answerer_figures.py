"""How good the answers of a world's answerer are: what it says, how sure it is of it, and what a robot does with it."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from random import Random
from statistics import fmean
from typing import Any, Protocol

from django.utils import timezone

from annotations.background.progress import UNWATCHED, Progress
from annotations.language.corpus import Part
from annotations.language.forms import CLASS_TOKEN
from annotations.language.texts import normalise
from annotations.language.world import Ontology
from annotations.models import Example, Split, World
from annotations.rows.from_rows import ontology_of
from parser_service.analysis.clustered import Clustered, Interval, interval_of
from parser_service.analysis.outcomes import name_clusters
from parser_service.analysis.scores import Judgement, judge
from parser_service.analysis.sureness import (
    AnsweredForm,
    Calibration,
    Decision,
    calibrations_by_cluster,
)
from parser_service.models import AnswererEvaluation, TrainingRun
from parser_service.models.answering import answering_of
from parser_service.parsers.conditions import PEOPLES, SOURCES, TEST_SOURCES
from parser_service.parsers.interface import UNKNOWN
from parser_service.runs.knowledge import plan_agreement_of
from parser_service.runs.split_pairs import cluster_of
from parser_service.serving.calibrating import Calibrated, point_of

AT_ONCE = 64
PARTS = (Part.VALIDATION, Part.TEST)
DECIMALS = 4
# Figure → the field that counts what it is a share of.
FIGURES = {
    "correct": "count",
    "same_plan": "count",
    "acted": "count",
    "wrong_acts": "acted",
    "confirmed": "count",
    "confirmed_right": "confirmed",
    "asked": "count",
    "refused": "count",
}


class Answerer(Protocol):
    """Whoever answers in a world. ``run`` is that of the learned parser and ``last_run`` the key of that of the last
    part, None where none is asked; ``order`` is an ``AnsweringOrder``."""

    @property
    def run(self) -> TrainingRun | None: ...

    @property
    def last_run(self) -> int | None: ...

    @property
    def order(self) -> str: ...

    def answer(self, utterances: Sequence[str]) -> Sequence[AnsweredForm]:
        """Return the answer to each utterance."""


@dataclass(frozen=True, slots=True)
class _Measured:
    """One example with its answer: how it was judged, how sure it is (cross-fitted), and what is done."""

    example: Example
    cluster: str
    answer: AnsweredForm
    judgement: Judgement
    probability: float | None = None
    decision: Decision = Decision.REFUSE

    @property
    def is_right(self) -> bool:
        return bool(self.judgement.is_same_plan)

    @property
    def counts(self) -> dict[str, bool]:
        """What of ``FIGURES``, and of what they are shares of, it counts for."""
        acts, confirms = self.decision == Decision.ACT, self.decision == Decision.CONFIRM
        return {
            "count": True,
            "correct": self.judgement.is_exact_match,
            "same_plan": self.is_right,
            "acted": acts,
            "wrong_acts": acts and not self.is_right,
            "confirmed": confirms,
            "confirmed_right": confirms and self.is_right,
            "asked": self.decision == Decision.ASK,
            "refused": self.decision == Decision.REFUSE,
        }


def evaluate_answerer(
    world: World,
    split: Split,
    answerer: Answerer,
    progress: Progress = UNWATCHED,
    allowed_wrong: float | None = None,
) -> list[AnswererEvaluation]:
    """Ask for every validation and test example of ``split``, store what came of it by part and source, and return
    the rows. They take the place of earlier ones of the same split, run and order.

    What people wrote or said in the validation part calibrates the answers and chooses the operating point; the
    probability of an example there is from a calibration without its cluster, so that reliability is honest.

    Args:
        allowed_wrong: the share of wrong ones among what is acted on; that of the world by default.

    Raises what ``progress`` raises to stop it, and LanguageError where a stored text of the world cannot be read.
    """
    allowed = answering_of(world).allowed_wrong if allowed_wrong is None else allowed_wrong
    revision = World.objects.values_list("revision", flat=True).get(pk=world.pk)
    measured = _ask(world, split, answerer.answer, progress)
    rows = [
        AnswererEvaluation(
            world=world,
            split=split,
            run=answerer.run,
            order=answerer.order,
            revision=revision,
            **values,
        )
        for values in _evaluate(measured, allowed, answerer.last_run)
    ]
    with progress.writing():
        same = {"split": split, "run": answerer.run, "order": answerer.order}
        AnswererEvaluation.objects.filter(world=world, **same).delete()
        AnswererEvaluation.objects.bulk_create(rows)
    return rows


def _ask(
    world: World,
    split: Split,
    answer: Callable[[Sequence[str]], Sequence[AnsweredForm]],
    progress: Progress,
) -> list[_Measured]:
    same_plan, ontology = plan_agreement_of(world), ontology_of(world)
    examples = list(split.examples.filter(part__in=PARTS))
    measured = []
    for start in range(0, len(examples), AT_ONCE):
        progress.check()
        some = examples[start : start + AT_ONCE]
        for example, given in zip(
            some, answer([as_said(each.utterance, ontology) for each in some]), strict=True
        ):
            judgement = judge(given.form or UNKNOWN, example.logical_form, same_plan)
            cluster = cluster_of(example, split.criterion)
            measured.append(_Measured(example, cluster, given, judgement))
        progress.report(len(measured) / len(examples), "asking for each example")
    return measured


def as_said(utterance: str, ontology: Ontology) -> str:
    """Return an utterance as a robot hears it: with an entity in place of each class token.

    Equal utterances have equal entities. Equal tokens with a number have the same one, all others differ, as far as
    there are enough of the class; a token of a class without an entity stays.
    """
    random = Random(utterance)
    left: dict[str, list[str]] = {}
    numbered: dict[str, str] = {}

    def fill(match: re.Match[str]) -> str:
        token = match[1]
        entity_class = token.rstrip("0123456789")
        if token in numbered:
            return numbered[token]
        if not left.get(entity_class):
            texts = [entity.text for entity in ontology.of_class(entity_class)]
            left[entity_class] = random.sample(texts, len(texts))
        if not left[entity_class]:
            return match[0]
        text = left[entity_class].pop()
        if token != entity_class:
            numbered[token] = text
        return text

    return CLASS_TOKEN.sub(fill, normalise(utterance))


def _evaluate(
    measured: Sequence[_Measured], allowed: float, last_run: int | None
) -> list[dict[str, Any]]:
    """Return the values of a row for each part and test source with examples; ``mixed`` where both have some."""
    calibrated, sure = _calibrate(measured, allowed)
    about = {
        **calibrated.calibration.to_json(),
        "point": {"act": calibrated.point.act, "confirm": calibrated.point.confirm},
        "allowed_wrong": allowed,
        "last_run": last_run,
    }
    made_at = timezone.now()
    rows = []
    for part in PARTS:
        of_part = [each for each in sure if each.example.part == part]
        there = {each.example.source for each in of_part}
        for name, sources in TEST_SOURCES.items():
            if there.issuperset(sources):
                chosen = [each for each in of_part if each.example.source in sources]
                place = {"part": part, "test_source": name, "made_at": made_at}
                rows.append({**place, "calibration": about, **_figures(chosen)})
    return rows


def _calibrate(measured: Sequence[_Measured], allowed: float) -> tuple[Calibrated, list[_Measured]]:
    """Return what is learned from the answers to people of the validation part, and all answers with their
    probability and decision."""
    peoples = {SOURCES[name] for name in PEOPLES}
    learned_from = [
        each
        for each in measured
        if each.example.part == Part.VALIDATION
        and each.example.source in peoples
        and each.answer.evidence
        and not each.answer.objections
    ]
    evidences = [each.answer.evidence for each in learned_from if each.answer.evidence]
    is_right = [each.is_right for each in learned_from]
    whole = Calibration.fit(evidences, is_right)
    clusters = [each.cluster for each in learned_from]
    without = calibrations_by_cluster(evidences, is_right, clusters)

    def probability(of: _Measured) -> float | None:
        if of.answer.evidence is None:
            return None
        is_validation = of.example.part == Part.VALIDATION
        fitted = without.get(of.cluster, whole) if is_validation else whole
        return round(fitted.probability(of.answer.evidence), DECIMALS)

    def settle(of: _Measured, calibrated: Calibrated) -> _Measured:
        sure = probability(of)
        decision = of.answer.decision(sure, calibrated.point, whole)
        return _Measured(of.example, of.cluster, of.answer, of.judgement, sure, decision)

    usual = Calibrated(whole, point_of([], allowed))
    answers = [_as_answer(settle(each, usual)) for each in learned_from]
    calibrated = Calibrated(whole, point_of(answers, allowed))
    return calibrated, [settle(each, calibrated) for each in measured]


def _as_answer(of: _Measured) -> list[Any]:
    return [of.probability, of.is_right, str(of.decision)]


def _figures(chosen: Sequence[_Measured]) -> dict[str, Any]:
    counts = [each.counts for each in chosen]
    sums = {name: sum(each[name] for each in counts) for name in counts[0]}
    answered = [each for each in chosen if each.answer.evidence and each.probability is not None]
    before = [each.answer.evidence.raw_probability for each in answered if each.answer.evidence]
    return {
        **sums,
        "intervals": _intervals(chosen, counts),
        "answers": [_as_answer(each) for each in chosen],
        "brier": _brier([each.probability or 0.0 for each in answered], answered),
        "brier_before": _brier(before, answered),
        "seconds": fmean(each.answer.seconds for each in chosen),
    }


def _brier(probabilities: Sequence[float], answered: Sequence[_Measured]) -> float | None:
    off = [(sure - each.is_right) ** 2 for sure, each in zip(probabilities, answered, strict=True)]
    return fmean(off) if off else None


def _intervals(
    chosen: Sequence[_Measured], counts: Sequence[dict[str, bool]]
) -> dict[str, Interval]:
    """Return the 95 % interval of each share that is one, by a bootstrap of clusters."""
    names = name_clusters({each.cluster for each in chosen})
    intervals = {}
    for figure, whole in FIGURES.items():
        tally: dict[str, list[int]] = defaultdict(lambda: [0, 0])
        for each, counted in zip(chosen, counts, strict=True):
            if counted[whole]:
                of_cluster = tally[names[each.cluster]]
                of_cluster[0] += counted[figure]
                of_cluster[1] += 1
        if tally:
            shares = Clustered.of([{name: (right, of) for name, (right, of) in tally.items()}])
            intervals[figure] = interval_of((shares,))
    return intervals
