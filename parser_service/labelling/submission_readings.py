"""What contributors wrote, as the best parser reads it: a flag where it is sure of another form than the prompt's."""

from __future__ import annotations

from itertools import groupby
from operator import itemgetter
from typing import Any

from annotations.background.progress import Progress
from annotations.language.corpus import FlagCode, Part
from annotations.language.texts import normalise
from annotations.models import Submission, World
from annotations.models.campaigns import SubmissionStatus
from annotations.models.splits import Source
from annotations.rows.synchronise import batches
from parser_service.analysis.scores import judge
from parser_service.labelling.label_candidates import is_label
from parser_service.models import TrainingRun
from parser_service.parsers.interface import Parser

MOST_READ = 5_000  # submissions of one job, the oldest first
TOGETHER = 64
SURE = 0.95  # a parser is sure where so many of its answers are right
LEAST_ANSWERS = 20  # that tell from which score on it is


def score_of_sure_answers(run: TrainingRun) -> float | None:
    """Return the least score at which ``run`` is sure, by what people said of the validation part: of its answers
    with that score or more, ``SURE`` were right. None where too few were."""
    answers = run.predictions.best().filter(example__part=Part.VALIDATION)
    by_people = answers.exclude(example__source__in=(Source.GENERATED, Source.MODEL))
    right, count, bound = 0, 0, None
    rows = by_people.order_by("-score").values_list("score", "is_equivalent")
    for score, alike in groupby(rows.iterator(), key=itemgetter(0)):
        for _, is_right in alike:
            right, count = right + is_right, count + 1
        if count >= LEAST_ANSWERS and right / count >= SURE:
            bound = score
    return bound


def read_submissions(
    world: World, run: TrainingRun, parser: Parser, progress: Progress
) -> dict[str, Any]:
    """Flag the rewrites that wait for moderation and that ``run`` is sure to ask for something else than their prompts.

    Each is read once by a run. What the run has learned from is not asked. Returns what the report of the job says.
    """
    waiting = Submission.objects.filter(contributor__campaign__world=world).awaiting_moderation()
    unread = waiting.filter(prompt__isnull=False).exclude(read_by_run=run.pk)
    rows = list(unread.select_related("prompt").order_by("pk")[:MOST_READ])
    bound = score_of_sure_answers(run) if rows else None
    if bound is None:
        return {}
    learned = set(run.split.examples.of(Part.TRAIN).values_list("utterance", flat=True))
    flagged = 0
    for number, some in enumerate(batches(rows, TOGETHER)):
        progress.report(number * TOGETHER / len(rows), "reading what contributors wrote")
        new = [row for row in some if row.text not in learned]
        answers = parser.predict([normalise(row.text) for row in new], 1, progress.check)
        others = {
            row.pk: candidates[0].form
            for row, candidates in zip(new, answers, strict=True)
            if candidates and candidates[0].score >= bound and is_label(candidates[0].form)
            if row.prompt and not judge(candidates[0].form, row.prompt.logical_form).is_equivalent
        }
        flagged += _store(some, run, others, progress)
    return {"read": len(rows), "flagged": flagged}


def _store(
    rows: list[Submission], run: TrainingRun, others: dict[int, str], progress: Progress
) -> int:
    """Note that ``run`` has read ``rows``, and what it is sure of. Leave out what was changed or decided meanwhile."""
    texts = {row.pk: row.text for row in rows}
    with progress.writing():
        held = Submission.objects.select_for_update().filter(
            pk__in=texts, status=SubmissionStatus.PENDING
        )
        left = [row for row in held.order_by("pk") if row.text == texts[row.pk]]
        for row in left:
            row.read_by_run = run.pk
            row.flags = [flag for flag in row.flags if flag["code"] != FlagCode.OTHER_FORM]
            if form := others.get(row.pk):
                row.flags.append({"code": FlagCode.OTHER_FORM, "evidence": form})
        Submission.objects.bulk_update(left, ["read_by_run", "flags"])
    return sum(row.pk in others for row in left)
