"""How far the analysis of a run is, as pages show it."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

from annotations.models import Job
from annotations.models.background import Status
from parser_service.models import TrainingRun
from parser_service.reviews.analysis_job import names_of_steps
from parser_service.reviews.stored_findings import VERSION
from parser_service.runs.analysis_requests import analysis_jobs


@dataclass(frozen=True, slots=True)
class AnalysisState:
    """``job`` is the last one, None where nobody asked; ``made_at`` when something was last found.

    ``is_complete`` where every step of this version of the code is stored; ``is_possible`` where the run has
    succeeded.
    """

    run: TrainingRun
    job: Job | None
    made_at: datetime | None
    is_complete: bool

    @property
    def is_active(self) -> bool:
        """Whether a worker has it or will have it."""
        return self.job is not None and not self.job.is_ended

    @property
    def is_possible(self) -> bool:
        return self.run.status == Status.SUCCEEDED

    @property
    def is_partial(self) -> bool:
        """Whether something is there to look at although not everything is."""
        return self.made_at is not None and not self.is_complete

    @property
    def failure(self) -> str:
        """What stopped the last job, as a sentence; empty where nothing did."""
        return self.job.failure if self.job else ""


def analysis_of(run: TrainingRun) -> AnalysisState:
    """Return the state of the analysis of ``run``, in two queries."""
    rows = [row for row in run.analyses.all() if row.version == VERSION]
    finished_steps = {name for row in rows for name in row.findings}
    return AnalysisState(
        run=run,
        job=analysis_jobs(run).first(),
        made_at=max((row.made_at for row in rows), default=None),
        is_complete=finished_steps >= names_of_steps(),
    )
