"""How far a campaign is: forms reached, pace, time left, cost."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from datetime import datetime, timedelta
from decimal import Decimal

from django.db.models import Count, Max, Min, Q
from django.utils import timezone

from annotations.models import Campaign, Submission
from annotations.models.campaigns import ContributorKind, SubmissionKind, SubmissionStatus
from annotations.rows.kept import kept

RECENT = timedelta(hours=1)


@dataclass(frozen=True, slots=True)
class CampaignProgress:
    """Counts of a campaign now.

    Attributes:
        forms: how many the campaign asks for; ``reached`` of them have their target.
        missing: rewrites that are still wanted, over all forms.
        rewrites: those answered and not rejected.
        per_hour: rewrites in the last hour, or since the first one where that is shorter.
        left: until all forms are reached at this rate; None where nothing comes in, or nothing is missing.
        cost: of the tasks that were finished; None without a price.
    """

    forms: int
    reached: int
    missing: int
    rewrites: int
    accepted: int
    waiting: int
    people: int
    finished: int
    per_hour: float
    left: timedelta | None
    cost: Decimal | None

    @property
    def seconds_left(self) -> float | None:
        return None if self.left is None else self.left.total_seconds()


def progress_of(campaign: Campaign) -> CampaignProgress:
    """Return how far a campaign is; of very many submissions, as of a while ago."""
    key = "campaign", campaign.pk, campaign.version, campaign.closed_at
    return kept(key, lambda: progress_at(campaign, timezone.now()), lambda now: now.rewrites)


def progress_at(campaign: Campaign, now: datetime) -> CampaignProgress:
    """Count what was submitted. Accepted paraphrases of the world that came another way count for a form, too."""
    forms = set(
        campaign.prompts.filter(check_words="").order_by().values_list("logical_form", flat=True)
    )
    rows = Submission.objects.filter(contributor__campaign=campaign).answered()
    rewrites = rows.filter(kind=SubmissionKind.REWRITE).exclude(status=SubmissionStatus.REJECTED)
    had = Counter(
        dict(rewrites.order_by().values_list("prompt__logical_form").annotate(Count("pk")))
    )
    elsewhere = campaign.world.paraphrases.accepted().exclude(contributor__campaign=campaign)
    for form, count in elsewhere.order_by().values_list("logical_form").annotate(Count("pk")):
        had[form] += count
    missing = sum(max(0, campaign.target_per_form - had[form]) for form in forms)
    by_link = Q(contributor__kind=ContributorKind.PERSON)
    totals = rewrites.aggregate(
        all=Count("pk"),
        accepted=Count("pk", filter=Q(status=SubmissionStatus.ACCEPTED)),
        # What came in a file or from a model came at once: it has no pace.
        recent=Count("pk", filter=Q(answered_at__gt=now - RECENT) & by_link),
        first=Min("answered_at", filter=by_link),
        last=Max("answered_at"),
    )
    people = campaign.contributors.filter(kind=ContributorKind.PERSON).aggregate(
        all=Count("pseudonym", distinct=True),
        finished=Count("pk", filter=Q(finished_at__isnull=False)),
    )
    hours = RECENT if totals["first"] is None else min(RECENT, now - totals["first"])
    per_hour = totals["recent"] / max(hours / timedelta(hours=1), 1 / 60)
    return CampaignProgress(
        forms=len(forms),
        reached=sum(had[form] >= campaign.target_per_form for form in forms),
        missing=missing,
        rewrites=totals["all"],
        accepted=totals["accepted"],
        waiting=rows.awaiting_moderation().count(),
        people=people["all"],
        finished=people["finished"],
        per_hour=per_hour,
        left=timedelta(hours=missing / per_hour) if missing and per_hour else None,
        cost=None if campaign.price is None else campaign.price * people["finished"],
    )
