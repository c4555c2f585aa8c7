"""How much may come to a campaign within a time: by its link, from one address, and from one contributor.

By the link, ``Campaign.most_per_hour`` tasks are begun in an hour, wherever they come from; the tasks themselves are
counted. From one address ``BEGUN_TASKS`` are begun: a class may sit behind it. The address is that of
``gpsr_site.web.proxies``, and it is not stored. One contributor saves ``MOST_SAVES`` answers in a minute; the row of
the contributor counts them, in the transaction that saves.
"""

from __future__ import annotations

import math
from datetime import timedelta
from http import HTTPStatus

from django.db.models import F
from django.utils import timezone

from annotations.language.texts import Refusal
from annotations.models import Campaign, Contributor
from annotations.models.campaigns import ContributorKind
from annotations.people.rate_limits import Rate

HOUR, MINUTE = timedelta(hours=1), timedelta(minutes=1)
BEGUN_TASKS = Rate("campaign", limit=300, seconds=3600)
MOST_SAVES = 60


class TooOften(Refusal):
    """More comes than people write."""

    code = "too_often"
    status = HTTPStatus.TOO_MANY_REQUESTS

    def __init__(self, message: str, wait: int) -> None:
        super().__init__(message)
        self.wait = wait


def require_share(campaign: Campaign) -> None:
    """Raise TooOften where the link has had its share of tasks within an hour. Call it where the campaign is locked."""
    people = campaign.contributors.filter(kind=ContributorKind.PERSON)
    # The one with which the link has had its share; in an hour it counts no more.
    beginnings = people.order_by("-began_at").values_list("began_at", flat=True)
    last = beginnings[campaign.most_per_hour - 1 : campaign.most_per_hour].first()
    left = timedelta() if last is None else last + HOUR - timezone.now()
    if left > timedelta():
        said = "Many people begin just now. Try again later: the link stays the same."
        raise TooOften(said, math.ceil(left.total_seconds()))


def count_task(address: str) -> None:
    """Count a task that is about to begin. Raises TooOften where the address has had its share."""
    if BEGUN_TASKS.take(address) is None:
        said = "Too many people begin from this address. Try again in an hour."
        raise TooOften(said, BEGUN_TASKS.seconds)


def require_patience(contributor: Contributor) -> None:
    """Raise TooOften where the contributor has saved more within a minute than one person writes."""
    if contributor.saves_since is None or contributor.saves < MOST_SAVES:
        return
    left = contributor.saves_since + MINUTE - timezone.now()
    if left > timedelta():
        said = "This is more than one person writes. Wait a minute, and go on."
        raise TooOften(said, math.ceil(left.total_seconds()))


def count_save(contributor: Contributor) -> None:
    """Count an answer that is saved. Call it in the transaction that saves."""
    now = timezone.now()
    since = contributor.saves_since
    is_same_minute = since is not None and since + MINUTE > now
    values = {"saves": F("saves") + 1} if is_same_minute else {"saves": 1, "saves_since": now}
    Contributor.objects.filter(pk=contributor.pk).update(**values)
