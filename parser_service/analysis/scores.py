"""How often a parser is right: exact match, equivalence, same plan, well-formedness and their intervals."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from statistics import fmean, stdev
from typing import Protocol, TypeAlias

from annotations.language.corpus import wilson_interval
from annotations.language.forms import Form, canonical_text, equivalent, read_form
from annotations.language.texts import LanguageError


class Judged(Protocol):
    """Whatever says how an answer was judged: a ``Judgement``, or a stored answer."""

    @property
    def is_exact_match(self) -> bool: ...

    @property
    def is_equivalent(self) -> bool: ...

    @property
    def is_well_formed(self) -> bool: ...

    @property
    def is_same_plan(self) -> bool | None: ...


@dataclass(frozen=True, slots=True)
class Judgement:
    """One answer against the label. Exact match is what accuracy counts.

    An exact match is equivalent, and what is equivalent has the same plan; None where plans were not compared.
    """

    is_exact_match: bool = False
    is_equivalent: bool = False
    is_well_formed: bool = False
    is_same_plan: bool | None = None


NO_ANSWER = Judgement()
SamePlan: TypeAlias = Callable[[Form, Form], bool]


@dataclass(frozen=True, slots=True)
class Score:
    """Answers to ``count`` utterances. Fractions of 1; the interval is Wilson's at 95 %. ``same_plan`` is None where
    plans were not compared."""

    count: int
    correct: int
    accuracy: float
    interval: tuple[float, float]
    equivalent: float
    well_formed: float
    same_plan: float | None = None


def judge(answer: str, annotated: str, same_plan: SamePlan | None = None) -> Judgement:
    """Compare a parser's answer, which may be no form, with a form. Equivalence also ignores the order of
    conjuncts; an answer is well-formed where it reads as a form with every variable bound. ``same_plan`` compares
    the plans of two forms that are not equivalent; without it plans are not compared."""
    try:
        form = read_form(answer)
    except LanguageError:
        return NO_ANSWER if same_plan is None else Judgement(is_same_plan=False)
    gold = read_form(annotated)
    is_exact = canonical_text(form) == canonical_text(gold)
    is_equivalent = is_exact or equivalent(form, gold)
    has_same_plan = None if same_plan is None else is_equivalent or same_plan(form, gold)
    return Judgement(is_exact, is_equivalent, True, has_same_plan)


def score(judgements: Sequence[Judged]) -> Score:
    """Return the share of right answers. Raises ValueError where there is nothing to count."""
    count = len(judgements)
    if not count:
        raise ValueError("There is no example to score.")
    correct = sum(judgement.is_exact_match for judgement in judgements)
    plans = [judgement.is_same_plan for judgement in judgements]
    return Score(
        count=count,
        correct=correct,
        accuracy=correct / count,
        interval=wilson_interval(correct, count),
        equivalent=sum(judgement.is_equivalent for judgement in judgements) / count,
        well_formed=sum(judgement.is_well_formed for judgement in judgements) / count,
        same_plan=None if None in plans else sum(map(bool, plans)) / count,
    )


@dataclass(frozen=True, slots=True)
class OverSeeds:
    """``mean`` and ``spread`` of ``n_seeds`` accuracies, fractions of 1.

    ``spread`` is the sample standard deviation (divisor n - 1), None for a single seed.
    """

    mean: float
    spread: float | None
    n_seeds: int


def over_seeds(accuracies: Sequence[float]) -> OverSeeds:
    """Return mean and spread of one accuracy per seed. Raises ValueError where there is none."""
    if not accuracies:
        raise ValueError("There is no seed to take a mean over.")
    spread = stdev(accuracies) if len(accuracies) > 1 else None
    return OverSeeds(fmean(accuracies), spread, len(accuracies))
