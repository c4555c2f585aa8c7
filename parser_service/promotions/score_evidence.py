"""What speaks for a run: its scores on what people said."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from annotations.language.corpus import KNOWN
from parser_service.models import Evaluation, TrainingRun
from parser_service.models.evaluations import ShownScore, shown_scores
from parser_service.parsers.conditions import in_words

SPOKEN = (
    "para",
    "said",
)  # test sources of what people say; the first that a run was tested on counts
# What runs are compared on: the test part is looked at when the choice is made.
COMPARED_ON = "validation"


def spoken_low(run: TrainingRun) -> float | None:
    """Return the lower end of the 95 % interval on validation paraphrases, a fraction of 1, and where there are none,
    on what people said; None for a run that was not asked any, or by form was asked for unseen forms alone."""
    scores = shown_scores(run.evaluations.all(), run.split.criterion)
    shown = next((scores[COMPARED_ON, of] for of in SPOKEN if (COMPARED_ON, of) in scores), None)
    return None if shown is None or shown.alone else shown.interval[0]


def known_low(run: TrainingRun) -> float:
    """Return the lower end of the 95 % interval on paraphrases of known forms, a fraction of 1, of a run on a split by
    form; 0 where it was not asked any."""
    asked = {each.test_source: each for each in run.evaluations.all() if each.part == KNOWN}
    return next((asked[source].interval_low for source in SPOKEN if source in asked), 0.0)


def is_right_on_paraphrases(run: TrainingRun) -> bool:
    """Return whether the run was tested on paraphrases, or on what people said, and is right on some."""
    return run.evaluations.filter(test_source__in=SPOKEN, correct__gt=0).exists()


def spoken_score(run: TrainingRun) -> Evaluation | None:
    """Return the score on validation paraphrases, where there are none that on what people said; None for a run
    that was not asked any."""
    scores = run.evaluations.all()  # which may have been fetched already
    asked = {each.test_source: each for each in scores if each.part == COMPARED_ON}
    return next((asked[source] for source in SPOKEN if source in asked), None)


@dataclass(frozen=True, slots=True)
class ComparedScore:
    """What a run reaches on one test source of one part, beside the run ``before`` it."""

    test_source: str
    part: str
    score: ShownScore | None
    before: ShownScore | None

    @property
    def tested_on(self) -> str:
        return in_words(self.test_source)

    @property
    def change(self) -> float | None:
        """Percentage points; None where only one of them was tested so, or one on unseen forms alone."""
        if self.score is None or self.before is None or self.score.alone != self.before.alone:
            return None
        return self.score.percent - self.before.percent


def compare_scores(run: TrainingRun, before: TrainingRun | None) -> list[ComparedScore]:
    """Return the scores of ``run`` beside those of ``before``, paraphrases first."""
    mine = shown_scores(run.evaluations.all(), run.split.criterion)
    theirs = shown_scores(before.evaluations.all(), before.split.criterion) if before else {}
    order = sorted(
        {*mine, *theirs}, key=lambda key: (key[1] not in SPOKEN, key[1], key[0] == "test")
    )
    return [
        ComparedScore(source, part, mine.get((part, source)), theirs.get((part, source)))
        for part, source in order
    ]


def evidence_for(run: TrainingRun, before: TrainingRun | None) -> dict[str, Any]:
    """Return the scores of ``run`` and of the run ``before`` it, as ``Promotion.evidence`` keeps them."""
    compared = {"run": before.pk, "scores": _scores(before)} if before else None
    return {"run": _scores(run), "before": compared}


def _scores(run: TrainingRun) -> list[dict[str, Any]]:
    return [
        {
            "test_source": score.test_source,
            "part": score.part,
            "count": score.count,
            "accuracy": score.accuracy,
            "low": score.interval_low,
            "high": score.interval_high,
        }
        for score in run.evaluations.order_by("part", "test_source")
    ]
