"""How sure an answer is, and what a robot does with it: act, confirm, ask or refuse.

The probability is a logistic regression on what is known of the answer (Platt, Probabilistic outputs for support
vector machines, 1999; Guo et al., On calibration of modern neural networks, ICML 2017), by maximum a posteriori with a
Gaussian prior around built-in weights: without an example it is these, and many examples win over them. The signs of
the weights are kept, so that no evidence against an answer can ever make it surer.

The operating point is chosen by the share of wrong acts that is allowed, as in selective classification (Geifman and
El-Yaniv, Selective classification for deep neural networks, NeurIPS 2017).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from math import exp, lgamma, log, log2
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike

from parser_service.analysis.arrays import Bools, Floats
from parser_service.analysis.clustered import folds_of

FOLDS = 5
FEW = 50  # examples that are too few to choose an operating point by
LEAST_PEOPLE = 40  # utterances without which no answer of a learned parser is acted on
UNLIKELY = 0.05  # what happens less often is no chance
LEAST_ACT = 0.5  # nothing is acted on that is rather wrong
LEAST_CONFIRM = 0.3  # below it a person would mostly say no
LEAST_UNCALIBRATED = 0.03  # the same where no utterance of people told what a score is worth
ALLOWED_WRONG = 0.02
LEAST, MOST = 0.001, 0.999  # nothing that was learned from some hundred examples is surer
_MOST_COUNTED = 3  # slots, names or words: a fourth says nothing new
# A network is often far surer than it is right, so that more of its own word says no more.
_MOST_COST, _MOST_LOG_ODDS, _MOST_MARGIN = 20.0, 4.0, 3.0


class AnsweringPart(StrEnum):
    """Which part of a world's answerer gave an answer."""

    ORACLE = "oracle"
    LEARNED = "learned"
    LAST = "last"


class Decision(StrEnum):
    """What a robot does with an answer."""

    ACT = "act"
    CONFIRM = "confirm"
    ASK = "ask"
    REFUSE = "refuse"


@dataclass(frozen=True, slots=True)
class Evidence:
    """What speaks for and against one answer.

    Of the oracle: ``is_exact``: it understood the words that were said, whatever noise is around them; ``heard_cost``:
    how many changes were made to hear it so; ``readings``: how many are equally good. Of the learned and the last part:
    the ``learned_log_probability`` of its answer, None where its scores are none, and by how many nats it is above the
    second (``margin``). ``agrees``: the other part gives the same form; None where it was not asked or is silent.

    Of either: how many slots nothing in the utterance names (``not_said``), how many named things the form has not
    (``left_out``), whether two slots are ``exchanged``, whether a robot can carry it out, and how many words nobody
    knows.
    """

    part: str
    is_exact: bool = False
    heard_cost: float = 0.0
    readings: int = 1
    learned_log_probability: float | None = None
    margin: float | None = None
    agrees: bool | None = None
    not_said: int = 0
    left_out: int = 0
    exchanged: bool = False
    executable: bool = True
    unknown_words: int = 0

    @property
    def is_learned(self) -> bool:
        return self.part != AnsweringPart.ORACLE

    @property
    def raw_probability(self) -> float:
        """What the part itself says, before anything is calibrated: an answer without a probability counts as
        certain, since it was given without a doubt."""
        if not self.is_learned or self.learned_log_probability is None:
            return 1.0
        return exp(min(self.learned_log_probability, 0.0))


class Weight(NamedTuple):
    """The prior of one weight: what it is by default, how far data may easily move it (standard deviation), and the
    sign that it keeps (0: any)."""

    default: float
    spread: float
    sign: int = 0


# Nats of log-odds for one unit of each feature (``_features``).
WEIGHTS: dict[str, Weight] = {
    "oracle": Weight(4.5, 0.4),
    "learned": Weight(-0.3, 1.0),
    "last": Weight(-0.5, 1.0, -1),
    "heard_otherwise": Weight(-1.8, 0.7, -1),
    "heard_cost": Weight(-0.1, 0.05, -1),
    "more_readings": Weight(-1.0, 0.5, -1),
    "learned_log_odds": Weight(0.7, 0.25, 1),
    "learned_without_probability": Weight(-0.7, 0.7, -1),
    "margin": Weight(0.1, 0.1, 1),
    "agrees": Weight(1.5, 0.7, 1),
    "disagrees": Weight(-0.5, 0.7, -1),
    "not_said": Weight(-2.5, 0.7, -1),
    "left_out": Weight(-2.5, 0.7, -1),
    "exchanged": Weight(-3.0, 0.7, -1),
    "not_executable": Weight(-0.5, 0.5, -1),
    "unknown_words": Weight(-2.0, 0.7, -1),
}
DEFAULT_WEIGHTS = {name: weight.default for name, weight in WEIGHTS.items()}


def _features(evidence: Evidence) -> list[float]:
    """Return the numbers that the weights multiply, in the order of ``WEIGHTS``."""
    is_learned, score = evidence.is_learned, evidence.learned_log_probability
    is_oracle = not is_learned
    values: dict[str, float] = {
        "oracle": is_oracle,
        "learned": is_learned,
        "last": evidence.part == AnsweringPart.LAST,
        "heard_otherwise": is_oracle and not evidence.is_exact,
        "heard_cost": min(evidence.heard_cost, _MOST_COST) if is_oracle else 0.0,
        "more_readings": log2(max(evidence.readings, 1)) if is_oracle else 0.0,
        "learned_log_odds": _log_odds(score) if is_learned and score is not None else 0.0,
        "learned_without_probability": is_learned and score is None,
        "margin": min(max(evidence.margin or 0.0, 0.0), _MOST_MARGIN) if is_learned else 0.0,
        "agrees": evidence.agrees is True,
        "disagrees": evidence.agrees is False,
        "not_said": min(evidence.not_said, _MOST_COUNTED),
        "left_out": min(evidence.left_out, _MOST_COUNTED),
        "exchanged": evidence.exchanged,
        "not_executable": not evidence.executable,
        "unknown_words": min(evidence.unknown_words, _MOST_COUNTED),
    }
    return [float(values[name]) for name in WEIGHTS]


def _log_odds(log_probability: float) -> float:
    """Return the log-odds of a probability whose logarithm is given, within ± ``_MOST_LOG_ODDS``."""
    probability = exp(min(log_probability, 0.0))
    if probability <= 0.0 or probability >= 1.0:
        return _MOST_LOG_ODDS if probability else -_MOST_LOG_ODDS
    return float(np.clip(log(probability / (1 - probability)), -_MOST_LOG_ODDS, _MOST_LOG_ODDS))


def _share(log_odds: ArrayLike) -> Floats:
    """Return the probabilities with these log-odds, any shape."""
    return np.exp(-np.logaddexp(0.0, np.negative(log_odds)))


@dataclass(frozen=True, slots=True)
class Calibration:
    """Turns evidence into a probability. ``examples`` is how many it was fitted to, ``last_examples`` how many of them
    the last part answered."""

    weights: Mapping[str, float] = field(default_factory=lambda: dict(DEFAULT_WEIGHTS))
    examples: int = 0
    last_examples: int = 0

    @classmethod
    def fit(cls, evidences: Sequence[Evidence], is_right: Sequence[bool]) -> Self:
        """Return the calibration with the most probable weights; the default without an example.

        The posterior is convex and the search starts at the default, so that equal examples in any order give equal
        weights (to the tolerance of the search).
        """
        # Not before something is fitted: whatever answers loads this module.
        from scipy.optimize import minimize

        if not evidences:
            return cls()
        features = np.array([_features(each) for each in evidences])  # [examples, features]
        signs = np.where(np.asarray(is_right, dtype=bool), 1.0, -1.0)  # [examples]
        priors = list(WEIGHTS.values())
        default = np.array([each.default for each in priors])
        precision = np.array([each.spread**-2 for each in priors])

        def negative_log_posterior(weights: Floats) -> tuple[float, Floats]:
            odds = signs * (features @ weights)
            off = weights - default
            loss = np.logaddexp(0.0, -odds).sum() + 0.5 * (precision * off**2).sum()
            slope = -(signs * _share(-odds)) @ features + precision * off
            return float(loss), slope

        bounds = [
            (0.0 if each.sign > 0 else None, 0.0 if each.sign < 0 else None) for each in priors
        ]
        search = minimize(
            negative_log_posterior, default, jac=True, method="L-BFGS-B", bounds=bounds
        )
        weights = dict(zip(WEIGHTS, map(float, search.x), strict=True))
        of_last = sum(each.part == AnsweringPart.LAST for each in evidences)
        return cls(weights, len(evidences), of_last)

    @classmethod
    def read(cls, values: Mapping[str, Any]) -> Self:
        """Read what ``to_json`` returned. A weight of an older version that is missing is the default."""
        stored = values.get("weights", {})
        weights = {name: float(stored.get(name, usual)) for name, usual in DEFAULT_WEIGHTS.items()}
        return cls(weights, int(values.get("examples", 0)), int(values.get("last_examples", 0)))

    def to_json(self) -> dict[str, Any]:
        return {
            "weights": dict(self.weights),
            "examples": self.examples,
            "last_examples": self.last_examples,
        }

    def has_people(self, part: str) -> bool:
        """Return whether enough utterances of people were answered to act on what a learned part says; of the last
        part, enough that it answered itself."""
        of_part = self.last_examples if part == AnsweringPart.LAST else self.examples
        return of_part >= LEAST_PEOPLE

    def probability(self, evidence: Evidence) -> float:
        """Return how probable it is that the answer has the plan that was meant, ``LEAST`` to ``MOST``."""
        weights = [self.weights[name] for name in WEIGHTS]
        odds = sum(map(float.__mul__, weights, _features(evidence)))
        return float(np.clip(_share(odds), LEAST, MOST))


@dataclass(frozen=True, slots=True)
class OperatingPoint:
    """The bounds between decisions: from ``act`` on an answer is acted on, from ``confirm`` on it is confirmed."""

    act: float = 1 - ALLOWED_WRONG
    confirm: float = LEAST_CONFIRM


def calibrations_by_cluster(
    evidences: Sequence[Evidence],
    is_right: Sequence[bool],
    clusters: Sequence[str],
    folds: int = FOLDS,
) -> dict[str, Calibration]:
    """Return for each cluster the calibration that was fitted without its fold (cross-fitting); the default where
    there is a single cluster.

    Args:
        evidences, is_right, clusters: of each example, [examples].
    """
    fold_of = folds_of(clusters, folds)
    fitted = {}
    for fold in set(fold_of.values()):
        others = [at for at, cluster in enumerate(clusters) if fold_of[cluster] != fold]
        fitted[fold] = Calibration.fit(
            [evidences[at] for at in others], [is_right[at] for at in others]
        )
    if not fold_of:
        return {cluster: Calibration() for cluster in clusters}
    return {cluster: fitted[fold] for cluster, fold in fold_of.items()}


def operating_point(
    probabilities: ArrayLike, is_right: Bools | Sequence[bool], allowed: float = ALLOWED_WRONG
) -> OperatingPoint:
    """Return the lowest bound that keeps the share of wrong acts at ``allowed`` or below.

    It is ``LEAST_ACT`` or more. With fewer than ``FEW`` examples it is 1 − ``allowed``, which calibrated probabilities
    keep by themselves. So it is where no bound is good enough, unless more is wrong from there on than chance explains:
    then it is above all that was seen.

    Args:
        probabilities: cross-fitted, 0 to 1: [examples].
        is_right: whether each answer has the plan that was meant, [examples].
    """
    given, right = np.asarray(probabilities, dtype=float), np.asarray(is_right, dtype=bool)
    by_promise = max(1 - allowed, LEAST_ACT)
    if len(given) < FEW:
        return OperatingPoint(by_promise)
    order = np.argsort(-given, kind="stable")
    surest, wrong = given[order], np.cumsum(~right[order])
    is_last = np.append(surest[1:] != surest[:-1], True)  # of equal probabilities all are acted on
    share = wrong / np.arange(1, len(surest) + 1)
    bounds = surest[is_last & (share <= allowed) & (surest >= LEAST_ACT)]
    if len(bounds):
        return OperatingPoint(float(bounds.min()))
    acted = given >= by_promise
    chance = _chance_of(int((~right[acted]).sum()), int(acted.sum()), allowed)
    above_all = float(np.nextafter(surest[0], np.inf))
    return OperatingPoint(by_promise if chance >= UNLIKELY else max(by_promise, above_all))


def _chance_of(wrong: int, count: int, allowed: float) -> float:
    """Return how probable it is that ``wrong`` or more of ``count`` are, where each is with probability ``allowed``."""
    if not 0 < allowed < 1:
        return float(not wrong or allowed >= 1)
    fewer = (
        exp(
            lgamma(count + 1)
            - lgamma(number + 1)
            - lgamma(count - number + 1)
            + number * log(allowed)
            + (count - number) * log(1 - allowed)
        )
        for number in range(wrong)
    )
    return max(0.0, 1 - sum(fewer))


def decide(
    probability: float | None,
    point: OperatingPoint,
    *,
    is_learned: bool,
    has_people: bool,
    open_slots: bool = False,
    executable: bool = True,
    objections: bool = False,
    ambiguous: bool = False,
) -> Decision:
    """Return what a robot does with an answer.

    Args:
        probability: that it is right; None where nothing was understood.
        is_learned: the learned parser gave it.
        has_people: there are utterances of people to calibrate on; else what a learned parser says is confirmed.
        open_slots: something that the plan needs was not said.
        objections: a prohibition, a condition, no command: no form is right.
        ambiguous: two things are equally near to what was said.
    """
    is_uncalibrated = is_learned and not has_people
    least = LEAST_UNCALIBRATED if is_uncalibrated else point.confirm
    if objections or probability is None or probability < least:
        return Decision.REFUSE
    if open_slots or ambiguous or not executable:
        return Decision.ASK
    if probability < point.act or is_uncalibrated:
        return Decision.CONFIRM
    return Decision.ACT


def percent_of(probability: float) -> int:
    """Return a probability as people read it: nothing is certain, so 1 to 99."""
    return min(max(round(100 * probability), 1), 99)


def in_words(decision: str, probability: float | None) -> str:
    """Say how sure an answer is: “sure”, “77 %: shall I?”, “95 %: one question”, “unsure: 3 %”, “not understood”."""
    if probability is None:
        return "not understood"
    percent = f"{percent_of(probability)} %"
    match decision:
        case Decision.ACT:
            return "sure"
        case Decision.CONFIRM:
            return f"{percent}: shall I?"
        case Decision.ASK:
            return f"{percent}: one question"
    return f"unsure: {percent}" if probability < LEAST_CONFIRM else "refused"


@dataclass(frozen=True, slots=True)
class AnsweredForm:
    """One answer of a world's answerer, as it is measured.

    ``form`` is anonymized corpus text, empty where nothing was understood; then there is no ``evidence``. The others
    are what ``decide`` takes. ``seconds`` are of processor time.
    """

    form: str = ""
    evidence: Evidence | None = None
    open_slots: bool = False
    objections: bool = False
    ambiguous: bool = False
    seconds: float = 0.0

    def decision(
        self, probability: float | None, point: OperatingPoint, calibration: Calibration
    ) -> Decision:
        """Return the decision at ``point``. A ``probability`` without evidence is none."""
        return decide(
            probability if self.evidence else None,
            point,
            is_learned=bool(self.evidence and self.evidence.is_learned),
            has_people=bool(self.evidence and calibration.has_people(self.evidence.part)),
            open_slots=self.open_slots,
            executable=bool(self.evidence and self.evidence.executable),
            objections=self.objections,
            ambiguous=self.ambiguous,
        )
