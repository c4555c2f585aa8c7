"""Verbs: begin a task of a campaign, and give it prompts of forms that have fewest submissions."""

from __future__ import annotations

from collections import Counter, defaultdict
from datetime import timedelta
from heapq import heapify, heappop, heappush
from http import HTTPStatus
from itertools import islice
from random import Random

from django.db import IntegrityError, transaction
from django.db.models import Count, Q
from django.utils import timezone

from annotations.language.errors import Refusal
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
    most = campaign.most_submissions
    answered = Submission.objects.filter(contributor__campaign=campaign).answered()
    if campaign.is_over or (most is not None and answered.count() >= most):
        raise CampaignOver


def contributor_of(campaign: Campaign, pseudonym: str) -> Contributor | None:
    """Return the latest task of a contributor; None where they have not begun one."""
    return campaign.contributors.filter(pseudonym=pseudonym).order_by("-attempt").first()


def begin(campaign: Campaign, pseudonym: str, kind: str = ContributorKind.PERSON) -> Contributor:
    """Return the task of a contributor, with all its places: the one that they have, or a new one.

    A finished task is begun anew only where the campaign allows it. Whoever begins twice at the same
    moment gets one task.

    Raises:
        CampaignOver: there is nothing to begin.
    """
    latest = contributor_of(campaign, pseudonym)
    if latest is not None and not (latest.is_finished and campaign.allows_retake):
        return latest
    require_open(campaign)
    attempt = 1 if latest is None else latest.attempt + 1
    # Chosen before anything is written: others write meanwhile.
    prompts = choose_prompts(campaign, campaign.task_size, pseudonym)
    checks = list(campaign.prompts.exclude(check_words=""))
    try:
        with transaction.atomic():
            contributor = Contributor.objects.create(
                campaign=campaign,
                pseudonym=pseudonym,
                attempt=attempt,
                kind=kind,
                consented_at=timezone.now(),
            )
            Submission.objects.bulk_create(_places(contributor, prompts, checks))
    except IntegrityError:
        return campaign.contributors.get(pseudonym=pseudonym, attempt=attempt)
    return contributor


def choose_prompts(campaign: Campaign, size: int, pseudonym: str = "") -> list[CampaignPrompt]:
    """Return ``size`` different prompts, or all that there are, in random order, as a ``Dealer`` deals them.

    What ``pseudonym`` had before comes last.
    """
    chosen = Dealer(campaign, pseudonym).deal(size)
    rows = CampaignPrompt.objects.in_bulk(chosen)
    return [rows[key] for key in chosen]


class Dealer:
    """Deals the prompts of a campaign, forms with fewest submissions first, or lines where these are balanced.

    What it has dealt counts as taken for what it deals next. A form, or line, comes twice in one task only when every
    other one has come; of its prompts the one comes first that was taken least.
    """

    def __init__(self, campaign: Campaign, pseudonym: str = "") -> None:
        self._random = Random(f"{campaign.seed}:{pseudonym}:{timezone.now().timestamp()}")
        self._prompts: dict[str, list[int]] = defaultdict(list)
        rewrites = campaign.prompts.filter(check_words="")
        balanced = "line" if campaign.balance == Balance.LINES else "logical_form"
        for key, group in rewrites.values_list("pk", balanced):
            self._prompts[group].append(key)
        self._taken = _taken(campaign)
        had = Submission.objects.filter(
            contributor__campaign=campaign, contributor__pseudonym=pseudonym
        )
        self._had = set(had.values_list("prompt_id", flat=True))
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
            self._prompts[group].sort(key=lambda key: (key in self._had, self._taken[key]))
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
            check = checks[(contributor.pk + number // campaign.check_every) % len(checks)]
            places.append((SubmissionKind.CHECK, check))
    places += [(SubmissionKind.FREE, None)] * campaign.free_commands
    return [
        Submission(contributor=contributor, position=position, kind=kind, prompt=prompt)
        for position, (kind, prompt) in enumerate(places, start=1)
    ]
