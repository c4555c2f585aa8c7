"""Figures of contributors: how fast they write, how much of it is accepted, how much is flagged."""

from __future__ import annotations

from dataclasses import dataclass
from math import isnan

from annotations.language.corpus import wilson_interval
from annotations.models import Campaign, Contributor, Submission, World
from annotations.models.campaigns import SubmissionKind, SubmissionStatus


@dataclass(frozen=True, slots=True)
class Pace:
    """Seconds that a rewrite took: the median and the quartiles around it."""

    lower: float
    median: float
    upper: float


@dataclass(frozen=True, slots=True)
class ContributorFigures:
    """What a contributor has answered. ``decided`` of it are accepted or rejected; checks need no decision.

    ``pace`` is None where nobody measured it, as for models.
    """

    contributor: Contributor
    answers: int
    flagged: int
    accepted: int
    decided: int
    pace: Pace | None

    @property
    def acceptance(self) -> float | None:
        """Accepted of those decided, a fraction of 1; None before a decision."""
        return self.accepted / self.decided if self.decided else None

    @property
    def interval(self) -> tuple[float, float] | None:
        """The 95 % interval of the acceptance."""
        return wilson_interval(self.accepted, self.decided) if self.decided else None

    # For sorting: nobody's acceptance and pace come last.
    @property
    def acceptance_or_last(self) -> float:
        return 2.0 if self.acceptance is None else self.acceptance

    @property
    def pace_or_last(self) -> float:
        return float("inf") if self.pace is None else self.pace.median


def contributors_of(world: World, campaign: Campaign | None = None) -> list[ContributorFigures]:
    """Return who has answered anything, in the campaigns of ``world`` or in ``campaign``, those flagged most first."""
    import pandas

    answered = Submission.objects.filter(contributor__campaign__world=world).answered()
    if campaign is not None:
        answered = answered.filter(contributor__campaign=campaign)
    columns = ("contributor", "kind", "status", "seconds", "flags")
    frame = pandas.DataFrame(answered.order_by().values_list(*columns), columns=columns)
    may_be_decided = frame.kind != SubmissionKind.CHECK
    frame["answers"] = 1
    frame["flagged"] = frame["flags"].astype(bool)
    frame["accepted"] = may_be_decided & (frame.status == SubmissionStatus.ACCEPTED)
    frame["decided"] = frame.accepted | may_be_decided & (frame.status == SubmissionStatus.REJECTED)
    frame["pace"] = frame.seconds.where(frame.kind == SubmissionKind.REWRITE).astype(float)
    of_each = frame.groupby("contributor")
    counts = of_each[["answers", "flagged", "accepted", "decided"]].sum().astype(int)
    paces = of_each.pace.quantile([0.25, 0.5, 0.75]).unstack()
    people = Contributor.objects.select_related("campaign").in_bulk(counts.index.tolist())
    rows = [
        ContributorFigures(
            *(people[row.Index], row.answers, row.flagged, row.accepted, row.decided),
            None if isnan(pace[0]) else Pace(*pace),
        )
        for row, pace in zip(counts.itertuples(), paces.itertuples(index=False), strict=True)
    ]
    return sorted(rows, key=lambda row: (-row.flagged, row.contributor.pk))
