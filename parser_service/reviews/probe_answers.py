"""Ask the parser of a run its probes, as it was asked the examples; what is answered is not asked again."""

from __future__ import annotations

from collections.abc import Sequence

from annotations.background.progress import Progress
from annotations.language.forms import UNKNOWN, canonical_text
from annotations.rows.synchronise import batches
from parser_service.analysis.answer_forms import is_same_answer
from parser_service.models import Expectation, Probe, ProbeAnswer
from parser_service.parsers.interface import Candidate
from parser_service.reviews.target import Target
from parser_service.runs.evaluating import AT_ONCE, BEAM_WIDTH
from parser_service.serving.loading import load_parser

REFUSALS = ("", canonical_text(UNKNOWN))


def answer_findings(target: Target, progress: Progress) -> dict[str, int]:
    """Store an answer for each probe. Returns how many there are.

    Raises Refusal where the parser cannot be loaded.
    """
    run = target.run
    waiting = list(run.probes.filter(answer__isnull=True).order_by("position"))
    total = run.probes.count()
    if waiting:
        progress.report(0, "loading the parser")
        parser = load_parser(run)
        for some in batches(waiting, AT_ONCE):
            done = total - len(waiting) + some[0].position - waiting[0].position
            progress.report(min(done / total, 1.0), "asking the parser its probes")
            texts = [probe.utterance for probe in some]
            answers = parser.predict(texts, BEAM_WIDTH, progress.check)
            rows = [_answer(*each) for each in zip(some, answers, strict=True)]
            with progress.writing():
                ProbeAnswer.objects.bulk_create(rows)
    return {"answered": total}


def is_refusal(answer: str) -> bool:
    """Return whether an answer is none, or UNKNOWN."""
    return answer in REFUSALS


def _answer(probe: Probe, candidates: Sequence[Candidate]) -> ProbeAnswer:
    best = candidates[0] if candidates else Candidate("", 0.0)
    is_expected = None  # where the probe expects nothing
    if probe.expectation == Expectation.UNKNOWN:
        is_expected = is_refusal(best.form)
    elif probe.expectation != Expectation.OPEN:
        is_expected = is_same_answer(best.form, probe.expected_form)
    return ProbeAnswer(
        probe=probe, logical_form=best.form, score=best.score, is_expected=is_expected
    )
