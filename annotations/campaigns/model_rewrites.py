"""Verbs: choose prompts for a language model, and store what it wrote, as for any contributor."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass

from django.db.models import Count
from django.utils import timezone

from annotations.campaigns.answering import flags_of, named_in
from annotations.campaigns.pseudonyms import pseudonym_of
from annotations.language.corpus import FlagCode, Named, instructions_version
from annotations.models import Campaign, CampaignPrompt, Contributor, Submission
from annotations.models.campaigns import ContributorKind, SubmissionKind, SubmissionStatus

# At most this share of what a form wants may come from models.
MODEL_SHARE = 0.5
LONGEST_RAW = 20_000  # characters of a reply that are kept
NO_REWRITE = "no_rewrite"  # the code of a reply in which no rewrite was found
# What nobody has to look at: a model writes another one for nothing.
DROPPED = {FlagCode.COPY, FlagCode.REPEAT, FlagCode.LOST_ENTITY, FlagCode.GIBBERISH}


@dataclass(frozen=True, slots=True)
class ModelSettings:
    """What a language model is asked with.

    Attributes:
        wordings: how many rewrites one request asks for.
        budget: requests that may be sent.
    """

    model: str
    instructions: str
    temperature: float = 0.8
    seed: int = 0
    wordings: int = 3
    budget: int = 500

    @property
    def version(self) -> str:
        return instructions_version(self.instructions)


def model_contributor(campaign: Campaign, settings: ModelSettings) -> Contributor:
    """Return the contributor that a model with these settings is: the same for the same settings."""
    described = {
        "model": settings.model,
        "instructions": settings.instructions,
        "version": settings.version,
        "temperature": settings.temperature,
        "seed": settings.seed,
    }
    identity = f"{settings.model}:{settings.version}:{settings.temperature}:{settings.seed}"
    contributor, _ = Contributor.objects.get_or_create(
        campaign=campaign,
        pseudonym=pseudonym_of(campaign, ContributorKind.MODEL, identity),
        attempt=1,
        defaults={
            "kind": ContributorKind.MODEL,
            "settings": described,
            "consented_at": timezone.now(),
        },
    )
    return contributor


@dataclass(frozen=True, slots=True)
class WantedRewrites:
    """A prompt, and how many rewrites of it are wanted."""

    prompt: CampaignPrompt
    number: int


def prompts_to_ask(
    contributor: Contributor,
    wordings: int,
    left_out: Collection[int] = (),
    share: float = MODEL_SHARE,
) -> list[WantedRewrites]:
    """Return the prompts that this contributor has not had, of forms that want more rewrites, in their order.

    Of each form as many prompts are taken as its missing rewrites need, with ``wordings`` for each at most; models
    together give at most ``share`` of a form's target.

    Args:
        left_out: keys of prompts that are not asked now.
    """
    campaign = contributor.campaign
    kept = Submission.objects.filter(
        contributor__campaign=campaign, kind=SubmissionKind.REWRITE
    ).exclude(status=SubmissionStatus.REJECTED)
    by_form = kept.answered().order_by().values_list("prompt__logical_form")
    had = Counter(dict(by_form.annotate(Count("pk"))))
    of_models = by_form.filter(contributor__kind=ContributorKind.MODEL)
    by_models = Counter(dict(of_models.annotate(Count("pk"))))
    most = int(campaign.target_per_form * share)
    asked = {*left_out, *contributor.submissions.values_list("prompt_id", flat=True)}
    wanted: list[WantedRewrites] = []
    given = Counter[str]()
    for prompt in campaign.prompts.filter(check_words=""):
        form = prompt.logical_form
        missing = min(campaign.target_per_form - had[form], most - by_models[form]) - given[form]
        if prompt.pk not in asked and missing > 0:
            wanted.append(WantedRewrites(prompt, min(wordings, missing)))
            given[form] += wordings
    return wanted


def exact_names(prompt: CampaignPrompt) -> tuple[Named, ...]:
    """Return the entities of ``prompt`` without other names: a model keeps them as they are written."""
    return tuple(Named(each.text, (), each.is_described) for each in named_in(prompt))


def store_rewrites(
    contributor: Contributor, prompt: CampaignPrompt, raw: str, rewrites: Sequence[str]
) -> list[Submission]:
    """Store the rewrites that were read from the reply ``raw``, each with its flags.

    Copies, repeats, gibberish and those that lost an entity are stored as rejected; so is a reply without
    a rewrite, with an empty text. Call it in a transaction; a prompt that was stored is not stored again.
    """
    if contributor.submissions.filter(prompt=prompt).exists():
        return []
    begun = contributor.submissions.count()
    now = timezone.now()
    stored = []
    for number, text in enumerate(rewrites or [""], start=begun + 1):
        submission = Submission(
            contributor=contributor,
            position=number,
            kind=SubmissionKind.REWRITE,
            prompt=prompt,
            text=text,
            raw=raw[:LONGEST_RAW],
            answered_at=now if text else None,
        )
        flags = flags_of(submission, exact_names(prompt))
        rows = [{"code": str(flag.code), "evidence": flag.evidence} for flag in flags]
        submission.flags = rows if text else [{"code": NO_REWRITE, "evidence": ""}]
        is_dropped = not text or any(flag.code in DROPPED for flag in flags)
        submission.status = SubmissionStatus.REJECTED if is_dropped else SubmissionStatus.PENDING
        submission.save()
        stored.append(submission)
    return stored
