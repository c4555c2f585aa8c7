"""What a figure of the results counts as right."""

from __future__ import annotations

from enum import StrEnum

from annotations.language.corpus import wilson_interval
from parser_service.analysis.outcomes import Counted, interval_of_outcomes
from parser_service.models import Evaluation


class Measure(StrEnum):
    """``EXACT`` counts forms that are the annotated one, ``EQUIVALENT`` also those that differ only in the
    order of their conjuncts, ``SAME_PLAN`` also those whose plan by the world's recipes is the same,
    ``WELL_FORMED`` all that are forms."""

    EXACT = "exact"
    EQUIVALENT = "equivalent"
    SAME_PLAN = "same_plan"
    WELL_FORMED = "well_formed"

    @property
    def in_words(self) -> str:
        return WORDS[self]

    @property
    def counted(self) -> Counted:
        """What outcomes call it."""
        return self.value

    @property
    def sign(self) -> str:
        return SIGNS[self]

    @property
    def column(self) -> str:
        """The field of a prediction that says whether it is right. Raises KeyError unless ``OF_EXAMPLES`` has it."""
        return OF_EXAMPLES[self][0]

    @property
    def outcomes(self) -> tuple[str, str]:
        """What right and wrong predictions are called (``OUTCOMES``). Raises KeyError likewise."""
        return OF_EXAMPLES[self][1:]


WORDS = {
    Measure.EXACT: "exact match",
    Measure.EQUIVALENT: "equivalent",
    Measure.SAME_PLAN: "same plan",
    Measure.WELL_FORMED: "well-formed",
}
SIGNS = {
    Measure.EXACT: "✓",
    Measure.EQUIVALENT: "≈",
    Measure.SAME_PLAN: "→",
    Measure.WELL_FORMED: "( )",
}
# The measures by which runs are compared example by example, the default first: field, right and wrong outcome.
OF_EXAMPLES = {
    Measure.EXACT: ("is_exact_match", "correct", "wrong"),
    Measure.SAME_PLAN: ("is_same_plan", "same_plan", "other_plan"),
}
FIELDS = {
    Measure.EXACT: "accuracy",
    Measure.EQUIVALENT: "equivalent",
    Measure.SAME_PLAN: "same_plan",
    Measure.WELL_FORMED: "well_formed",
}


def is_known(score: Evaluation, measure: Measure) -> bool:
    """Return whether the share of answers that ``measure`` counts is known: that of plans only where they were
    compared."""
    return getattr(score, FIELDS[measure]) is not None


def share_of(score: Evaluation, measure: Measure) -> float:
    """Return the share of answers that ``measure`` counts, as a fraction of 1. It has to be known."""
    return float(getattr(score, FIELDS[measure]))


def count_of(score: Evaluation, measure: Measure) -> int:
    """Return the number of answers that ``measure`` counts."""
    return (
        score.correct if measure is Measure.EXACT else round(share_of(score, measure) * score.count)
    )


def interval_of(score: Evaluation, measure: Measure) -> tuple[float, float]:
    """Return the 95 % interval of the share, as fractions of 1: Wilson's where answers were not counted by
    cluster."""
    if measure is Measure.EXACT:
        return score.interval_low, score.interval_high
    if interval := interval_of_outcomes(score.outcomes, measure.counted):
        return interval
    return wilson_interval(count_of(score, measure), score.count)
