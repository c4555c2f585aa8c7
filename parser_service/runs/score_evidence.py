"""What speaks for a run: its scores on what people said."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from annotations.generation.split_statistics import figures_of
from annotations.language.corpus import KNOWN
from parser_service.models import TrainingRun
from parser_service.models.evaluations import ShownScore, shown_scores
from parser_service.parsers.conditions import in_words
from parser_service.parsers.recommendation import LEAST_RIGHT, MANY_NEW_FORMS
from parser_service.parsers.registry import parsers

SPOKEN = ("para", "said")  # test sources of what people say; the first with enough of them counts
ENOUGH_SAID = 20  # utterances of people, to judge a run by them
# What runs are compared on: the test part is looked at when the choice is made.
COMPARED_ON = "validation"


def judged_by(*runs: TrainingRun) -> list[ShownScore]:
    """Return the scores by which ``runs`` are compared, one of each, all on one test source; none where there is no
    source that all were tested on.

    What people say counts, where each run was asked enough of it: a learned parser answers where the grammar oracle is
    silent. Else generated commands and paraphrases together do, then generated commands, then what there is of people.
    """
    of_runs = [
        {
            source: score
            for (part, source), score in shown_scores(
                run.evaluations.all(), run.split.criterion
            ).items()
            if part == COMPARED_ON
        }
        for run in runs
    ]
    enough = [
        {source for source, score in scores.items() if score.score.count >= ENOUGH_SAID}
        for scores in of_runs
    ]
    shared = set.intersection(*(set(scores) for scores in of_runs))
    order = [source for source in SPOKEN if all(source in of_run for of_run in enough)]
    for source in (*order, "mixed", "gen", *SPOKEN):
        if source in shared:
            return [scores[source] for scores in of_runs]
    return []


def known_low(run: TrainingRun) -> float:
    """Return the lower end of the 95 % interval on paraphrases of known forms, a fraction of 1, of a run on a split by
    form; 0 where it was not asked any."""
    asked = {each.test_source: each for each in run.evaluations.all() if each.part == KNOWN}
    return next((asked[source].interval_low for source in SPOKEN if source in asked), 0.0)


def why_not(run: TrainingRun) -> str:
    """Say why the rule does not promote a run, whatever is promoted now; empty where nothing speaks against it."""
    entry = parsers().get(run.parser)
    if entry is None or not entry.learns:
        return "It learns nothing, so it needs no run."
    if run.train_share != 1:
        return "It learned from a share of the training pairs."
    if not entry.writes_new_forms and figures_of(run.split).new_form_share >= MANY_NEW_FORMS:
        return "A third or more of the validation part asks for forms that it cannot answer with."
    scores = shown_scores(run.evaluations.all(), run.split.criterion)
    asked = [
        score
        for (part, source), score in scores.items()
        if part == COMPARED_ON
        and (source == "gen" or (source in SPOKEN and score.score.count >= ENOUGH_SAID))
    ]
    if not asked:
        return f"It was tested on fewer than {ENOUGH_SAID} utterances of people, and on no generated command."
    if any(score.accuracy < LEAST_RIGHT for score in asked):
        return "It is wrong more often than right on what people say, or on generated commands."
    return ""


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
