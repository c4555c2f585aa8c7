"""What a trained parser answers to the pairs of a part, and what a cell says of it."""

from __future__ import annotations

import time
from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from hashlib import sha256
from math import inf
from typing import Any

import numpy as np

from parser_service.analysis.clustered import Clustered, Parts, interval_of
from parser_service.analysis.probabilities import NO_PROBABILITY, probability_of, reliability
from parser_service.analysis.risk_coverage import risk_coverage
from parser_service.analysis.scores import Judgement, SamePlan, judge
from parser_service.parsers.interface import Pair, Parser, ScoreKind
from parser_service.runs.cross_fitting import calibrated_folds
from parser_service.runs.evaluating import BEAM_WIDTH

NAME_DIGITS = 12  # of the SHA-256 that stands for a cluster: a form is long
CURVE_POINTS = 50
DECIMALS = 6
ClusterOf = Callable[[Pair], str]


@dataclass(frozen=True, slots=True)
class PairAnswer:
    """The first answer to one pair. ``score`` is None where the parser has none."""

    cluster: str
    judgement: Judgement
    score: float | None


@dataclass(frozen=True, slots=True)
class PartAnswers:
    """The first answers of a parser to the pairs of a part, and the seconds that answering took."""

    of: tuple[PairAnswer, ...]
    seconds: float
    kind: ScoreKind | None

    @property
    def judgements(self) -> list[Judgement]:
        return [answer.judgement for answer in self.of]

    @property
    def accuracy(self) -> float | None:
        """The share that is right; None without a pair."""
        right = sum(answer.judgement.is_exact_match for answer in self.of)
        return right / len(self.of) if self.of else None

    @property
    def milliseconds(self) -> float:
        return 1000 * self.seconds / len(self.of) if self.of else 0.0

    @property
    def same_plan(self) -> float | None:
        """The share that has the plan of the label; None without a pair."""
        right = sum(bool(answer.judgement.is_same_plan) for answer in self.of)
        return right / len(self.of) if self.of else None

    def tally(self, by_plan: bool = False) -> dict[str, list[int]]:
        """Return cluster, as digits of its SHA-256, → [right answers, pairs], in the order of the digits.

        Right are exact matches; with ``by_plan`` answers with the same plan.
        """
        tally: dict[str, list[int]] = defaultdict(lambda: [0, 0])
        for answer in self.of:
            name = sha256(answer.cluster.encode()).hexdigest()[:NAME_DIGITS]
            judgement = answer.judgement
            tally[name][0] += bool(judgement.is_same_plan) if by_plan else judgement.is_exact_match
            tally[name][1] += 1
        return dict(sorted(tally.items()))

    def calibration(self) -> dict[str, Any] | None:
        """Return expected calibration error, Brier score and risk–coverage curve; None without a pair.

        The first two are None, with a ``note``, where scores are no probabilities.
        """
        if not self.of:
            return None
        right = np.array([answer.judgement.is_exact_match for answer in self.of])
        # Where there is no answer, nothing is surer to be wrong.
        scores = [-inf if answer.score is None else answer.score for answer in self.of]
        curve = risk_coverage(scores, right)
        thinned = curve.thin(CURVE_POINTS)
        about: dict[str, Any] = {
            "area": round(curve.area, DECIMALS),
            "best_area": round(curve.best_area, DECIMALS),
            "coverage": np.round(thinned.coverage[1:], DECIMALS).tolist(),
            "risk": np.round(thinned.risk[1:], DECIMALS).tolist(),
            "expected_calibration_error": None,
            "brier_score": None,
        }
        given = [probability_of(score, self.kind) for score in scores]
        numbers = [each for each in given if each is not None]
        if len(numbers) < len(given):
            return {**about, "note": NO_PROBABILITY}
        measured = reliability(numbers, right)
        return {
            **about,
            "expected_calibration_error": round(measured.error, DECIMALS),
            "brier_score": round(measured.brier, DECIMALS),
        }


def ask(
    parser: Parser, pairs: Sequence[Pair], cluster_of: ClusterOf, same_plan: SamePlan
) -> PartAnswers:
    """Ask for the first answer to each pair; ``same_plan`` compares its plan with that of the pair's form."""
    began = time.perf_counter()
    ranked = parser.predict([pair.utterance for pair in pairs], BEAM_WIDTH) if pairs else []
    seconds = time.perf_counter() - began
    answers = []
    for candidates, pair in zip(ranked, pairs, strict=True):
        form, score = (candidates[0].form, candidates[0].score) if candidates else ("", None)
        judgement = judge(form, pair.form, same_plan)
        answers.append(PairAnswer(cluster_of(pair), judgement, score))
    return PartAnswers(tuple(answers), seconds, parser.score_kind)


def ask_cross_fitted(
    parser: Parser,
    pairs: Sequence[Pair],
    calibrating: Sequence[Pair],
    cluster_of: ClusterOf,
    same_plan: SamePlan,
) -> PartAnswers:
    """Ask for the first answer to each pair of the validation part; each is scored by the parser calibrated on the
    pairs of other clusters. The answers are in no order that means anything."""
    folds = [
        ask(of_fold, [pairs[at] for at in places], cluster_of, same_plan)
        for of_fold, places in calibrated_folds(
            parser,
            [cluster_of(pair) for pair in pairs],
            calibrating,
            [cluster_of(pair) for pair in calibrating],
        )
    ]
    answers = tuple(answer for fold in folds for answer in fold.of)
    return PartAnswers(answers, sum(fold.seconds for fold in folds), parser.score_kind)


def intervals(answers: dict[str, PartAnswers]) -> Iterator[tuple[str, Any]]:
    """Yield the interval (fractions of 1), that of the share with the same plan, and the number of clusters of each
    part with an answer. The names of ``known`` and ``test`` end with the part. By form the interval of the harmonic
    mean comes too."""
    parts = {
        part: Clustered.of([each.tally()])  # type: ignore[list-item]
        for part, each in answers.items()
        if each.of
    }
    for part, clustered in parts.items():
        ending = "" if part == "validation" else f"_{part}"
        yield f"interval{ending}", rounded_interval((clustered,))
        by_plan = Clustered.of([answers[part].tally(by_plan=True)])  # type: ignore[list-item]
        yield f"interval_same_plan{ending}", rounded_interval((by_plan,))
        yield f"clusters{ending}", clustered.clusters
    if "known" in parts:
        both = (parts["validation"], parts["known"])
        yield "interval_harmonic_mean", rounded_interval(both)


def rounded_interval(parts: Parts) -> list[float]:
    return [round(end, DECIMALS) for end in interval_of(parts)]
