"""Verbs: begin a task of a campaign, and give it prompts of forms that have fewest submissions."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable
from datetime import timedelta
from heapq import heapify, heappop, heappush
from http import HTTPStatus
from itertools import islice
from random import Random

from django.db import IntegrityError, transaction
from django.db.models import Count, Max, Q
from django.utils import timezone

from annotations.campaigns.limits import require_share
from annotations.language.texts import Refusal
from annotations.models import Campaign, CampaignPrompt, Contributor, Submission
from annotations.models.campaigns import Balance, ContributorKind, SubmissionKind

HELD = timedelta(hours=1)  # a prompt that was given counts as taken for so long


class CampaignOver(Refusal):
    """A campaign takes nothing any more, from new people or from anybody."""

    code = "campaign_over"
    status = HTTPStatus.GONE

    def __init__(self, has_begun: bool = False) -> None:
        thanks = (
            "What you wrote is kept. Thank you." if has_begun else "Thank you for your interest."
        )
        super().__init__(f"This campaign is over. {thanks}")


def require_open(campaign: Campaign) -> None:
    """Raise CampaignOver where the campaign was closed, its time is up, or it has all that it wanted."""
    if campaign.is_over or is_full(campaign):
        raise CampaignOver


def is_full(campaign: Campaign) -> bool:
    """Return whether a campaign has as many submissions as it wants."""
    most = campaign.most_submissions
    answered = Submission.objects.filter(contributor__campaign=campaign).answered()
    return most is not None and answered.count() >= most


def close_if_full(campaign: Campaign) -> None:
    """Close a campaign with the last submission that it wants. Who has begun may finish."""
    if campaign.most_submissions is not None and campaign.closed_at is None and is_full(campaign):
        now = timezone.now()
        Campaign.objects.filter(pk=campaign.pk, closed_at__isnull=True).update(closed_at=now)


def contributor_of(campaign: Campaign, pseudonym: str) -> Contributor | None:
    """Return the latest task that somebody has begun by link; None where there is none."""
    by_link = campaign.contributors.filter(pseudonym=pseudonym, kind=ContributorKind.PERSON)
    return by_link.order_by("-attempt").first()


def begin(campaign: Campaign, pseudonym: str, kind: str = ContributorKind.PERSON) -> Contributor:
    """Return the task of a contributor, with all its places: the one that they have, or a new one.

    A finished task is begun anew only where the campaign allows it. Whoever begins twice at the same
    moment gets one task.

    Raises:
        CampaignOver: there is nothing to begin.
        TooOften: the link has had its share of this hour.
    """
    latest = contributor_of(campaign, pseudonym)
    if latest is not None and not (latest.is_finished and campaign.allows_retake):
        return latest
    require_open(campaign)
    # Files of results have attempts of the same people.
    attempts = campaign.contributors.filter(pseudonym=pseudonym).aggregate(last=Max("attempt"))
    attempt = (attempts["last"] or 0) + 1
    # Chosen before anything is written: others write meanwhile.
    prompts = choose_prompts(campaign, campaign.task_size, pseudonym)
    checks = list(campaign.prompts.exclude(check_words=""))
    try:
        with transaction.atomic():
            if kind == ContributorKind.PERSON:
                # One after the other: of many who begin at once, no more do than the link allows.
                require_share(Campaign.objects.select_for_update().get(pk=campaign.pk))
            contributor = Contributor.objects.create(
                campaign=campaign,
                pseudonym=pseudonym,
                attempt=attempt,
                kind=kind,
                consented_at=timezone.now(),
            )
            Submission.objects.bulk_create(_places(contributor, prompts, checks))
    except IntegrityError:
        begun = contributor_of(campaign, pseudonym)
        if begun is None:
            raise
        return begun
    return contributor


def preview_places(campaign: Campaign) -> list[Submission]:
    """Return the places of a task that nobody does; nothing is stored, and nothing counts as given."""
    prompts = list(campaign.prompts.filter(check_words="")[: campaign.task_size])
    checks = list(campaign.prompts.exclude(check_words=""))
    return _places(Contributor(campaign=campaign), prompts, checks)


def choose_prompts(campaign: Campaign, size: int, pseudonym: str = "") -> list[CampaignPrompt]:
    """Return ``size`` different prompts, or all that there are, in random order, as a ``Dealer`` deals them.

    What ``pseudonym`` had before comes only where there is nothing else.
    """
    had = Submission.objects.filter(
        contributor__campaign=campaign, contributor__pseudonym=pseudonym, prompt__isnull=False
    )
    before = frozenset(had.values_list("prompt_id", flat=True))
    chosen = Dealer(campaign, pseudonym, lambda key: key not in before).deal(size)
    if before and len(chosen) < size:
        again = Dealer(campaign, pseudonym, lambda key: key in before)
        chosen += again.deal(size - len(chosen))
    rows = CampaignPrompt.objects.in_bulk(chosen)
    return [rows[key] for key in chosen]


class Dealer:
    """Deals the prompts of a campaign, forms with fewest submissions first, or lines where these are balanced.

    What it has dealt counts as taken for what it deals next. A form, or line, comes twice in one task only when every
    other one has come; of its prompts the one comes first that was taken least.
    """

    def __init__(
        self,
        campaign: Campaign,
        pseudonym: str = "",
        may_deal: Callable[[int], bool] = lambda key: True,
    ) -> None:
        self._random = Random(f"{campaign.seed}:{pseudonym}:{timezone.now().timestamp()}")
        self._prompts: dict[str, list[int]] = defaultdict(list)
        rewrites = campaign.prompts.filter(check_words="")
        balanced = "line" if campaign.balance == Balance.LINES else "logical_form"
        for key, group in rewrites.values_list("pk", balanced):
            if may_deal(key):
                self._prompts[group].append(key)
        self._taken = _taken(campaign)
        self._groups = [
            (sum(self._taken[key] for key in prompts), self._random.random(), group)
            for group, prompts in self._prompts.items()
        ]
        heapify(self._groups)

    def deal(self, size: int) -> list[int]:
        """Return the keys of ``size`` different prompts, or of all that there are, in random order."""
        turns = [heappop(self._groups) for _ in range(min(size, len(self._groups)))]
        for _, _, group in turns:
            self._random.shuffle(self._prompts[group])
            self._prompts[group].sort(key=self._taken.__getitem__)
        longest = max((len(self._prompts[group]) for _, _, group in turns), default=0)
        rounds = (
            (group, self._prompts[group][turn])
            for turn in range(longest)
            for _, _, group in turns
            if turn < len(self._prompts[group])
        )
        dealt = list(islice(rounds, size))
        of_group = Counter(group for group, _ in dealt)
        for taken, _, group in turns:
            heappush(self._groups, (taken + of_group[group], self._random.random(), group))
        chosen = [key for _, key in dealt]
        self._taken.update(chosen)
        self._random.shuffle(chosen)
        return chosen


def _taken(campaign: Campaign) -> Counter[int]:
    """Count the submissions of each prompt: what was answered, and what was given within the last hour."""
    is_taken = ~Q(text="") | Q(given_at__gt=timezone.now() - HELD)
    rows = Submission.objects.filter(
        is_taken, contributor__campaign=campaign, kind=SubmissionKind.REWRITE
    )
    return Counter(dict(rows.order_by().values_list("prompt").annotate(Count("pk"))))


def _places(
    contributor: Contributor, prompts: list[CampaignPrompt], checks: list[CampaignPrompt]
) -> list[Submission]:
    """Return the places of a task: prompts, a check after every so many, and free commands at the end."""
    campaign = contributor.campaign
    places: list[tuple[str, CampaignPrompt | None]] = []
    for number, prompt in enumerate(prompts, start=1):
        places.append((SubmissionKind.REWRITE, prompt))
        if checks and number % campaign.check_every == 0:
            check = checks[((contributor.pk or 0) + number // campaign.check_every) % len(checks)]
            places.append((SubmissionKind.CHECK, check))
    places += [(SubmissionKind.FREE, None)] * campaign.free_commands
    return [
        Submission(contributor=contributor, position=position, kind=kind, prompt=prompt)
        for position, (kind, prompt) in enumerate(places, start=1)
    ]
