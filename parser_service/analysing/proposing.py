"""Propose an error category for each wrong answer, once it is known which forms attract."""

from __future__ import annotations

from annotations.background.progress import Progress
from parser_service.analysing.attracting import attractors_in
from parser_service.analysing.findings import findings_of
from parser_service.analysing.target import Target, parts_of
from parser_service.reviewing.proposing import propose_for_run


def proposal_findings(target: Target, progress: Progress) -> dict[str, int]:
    """Store a proposal for each error of the run, on every part. Returns how many there are."""
    target.forget_answers()  # the proposals read all of them once more
    run = target.run
    found = (attractors_in(findings_of(run, part)) for part in parts_of(run))
    return {"proposed": propose_for_run(run, frozenset().union(*found), progress)}
