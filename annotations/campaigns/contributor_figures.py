"""Figures of contributors: how fast they write, how much of it is accepted, how much is flagged."""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass
from statistics import quantiles

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
    answered = Submission.objects.filter(contributor__campaign__world=world).answered()
    if campaign is not None:
        answered = answered.filter(contributor__campaign=campaign)
    answers, flagged = Counter[int](), Counter[int]()
    decisions: dict[int, Counter[str]] = defaultdict(Counter)
    seconds: dict[int, list[float]] = defaultdict(list)
    columns = ("contributor", "kind", "status", "seconds", "flags")
    for key, kind, status, lasted, flags in answered.order_by().values_list(*columns):
        answers[key] += 1
        flagged[key] += bool(flags)
        if kind != SubmissionKind.CHECK:
            decisions[key][status] += 1
        if kind == SubmissionKind.REWRITE and lasted is not None:
            seconds[key].append(lasted)
    people = Contributor.objects.filter(campaign__world=world).select_related("campaign")
    rows = []
    for each in people if campaign is None else people.filter(campaign=campaign):
        if each.pk in answers:
            made = decisions[each.pk]
            accepted = made[SubmissionStatus.ACCEPTED]
            decided = accepted + made[SubmissionStatus.REJECTED]
            rows.append(
                ContributorFigures(
                    *(each, answers[each.pk], flagged[each.pk]),
                    *(accepted, decided, _pace(seconds[each.pk])),
                )
            )
    return sorted(rows, key=lambda row: (-row.flagged, row.contributor.pk))


def _pace(seconds: list[float]) -> Pace | None:
    if not seconds:
        return None
    if len(seconds) == 1:
        return Pace(*seconds * 3)
    return Pace(*quantiles(seconds, n=4, method="inclusive"))
