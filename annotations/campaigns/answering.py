"""Verbs: save what a contributor writes, and finish their task."""

from __future__ import annotations

from collections.abc import Sequence
from http import HTTPStatus

from django.db import transaction
from django.utils import timezone

from annotations.campaigns.limits import count_save
from annotations.campaigns.tasks import CampaignOver, close_if_full
from annotations.labelling.proposal_requests import request_readings
from annotations.language.corpus import (
    Flag,
    FreeCommand,
    Named,
    Rewrite,
    RewriteWarning,
    check_flags,
    check_rewrite,
    free_command_flags,
    rewrite_flags,
)
from annotations.language.texts import (
    KnownWords,
    Position,
    Refusal,
    normalise_line,
    require_writable,
)
from annotations.models import CampaignPrompt, Contributor, Submission
from annotations.models.campaigns import ContributorKind, SubmissionKind, SubmissionStatus
from annotations.models.corpus import MOST_CHARACTERS

MOST_COMPARED = 500  # texts that one submission is compared with


def named_in(prompt: CampaignPrompt) -> tuple[Named, ...]:
    """Return the entities that a rewrite of ``prompt`` has to keep."""
    return tuple(
        Named(row["text"], tuple(row["aliases"]), row["is_described"]) for row in prompt.entities
    )


def warnings_for(submission: Submission, text: str) -> tuple[RewriteWarning, ...]:
    """Return what to tell the writer of ``text``. All of it is advice."""
    prompt = submission.prompt
    if prompt is None or submission.kind != SubmissionKind.REWRITE:
        return ()
    return check_rewrite(normalise_line(text), prompt.shown, named_in(prompt))


def save_answer(
    submission: Submission,
    text: str,
    seconds: float | None = None,
    was_pasted: bool = False,
    browser: str = "",
) -> Submission:
    """Store what was written at a place of a task, with its flags. An empty text empties the place again.

    Saving the same twice changes nothing. Who changes what they wrote has looked at the prompt for ``seconds``
    more, and what was pasted once stays pasted. ``browser`` is the one that is shown the text again.

    Raises:
        Refusal: the text is too long or no text, or the task is finished.
        CampaignOver: the campaign ended, and the time is up in which those who have begun may finish.
    """
    wanted = normalise_line(text)
    require_writable(wanted, Position())
    if len(wanted) > MOST_CHARACTERS:
        raise Refusal(f"Use at most {MOST_CHARACTERS} characters.", "too_long")
    stored = Submission.objects.select_related("contributor__campaign", "prompt").get(
        pk=submission.pk
    )
    _require_changeable(stored)
    if stored.text == wanted:
        return stored
    stored.text, stored.browser = wanted, browser
    stored.was_pasted = stored.was_pasted or was_pasted
    if seconds is not None:
        stored.seconds = (stored.seconds or 0) + seconds
    stored.answered_at = timezone.now() if wanted else None
    # Worked out before the row is held: others write meanwhile.
    stored.flags = [{"code": flag.code, "evidence": flag.evidence} for flag in flags_of(stored)]
    with transaction.atomic():
        held = Submission.objects.select_for_update(of=("self",)).select_related(
            "contributor__campaign"
        )
        _require_changeable(held.get(pk=submission.pk))
        count_save(stored.contributor)
        stored.read_by_run = None
        columns = (
            "text",
            "browser",
            "was_pasted",
            "seconds",
            "answered_at",
            "flags",
            "read_by_run",
        )
        stored.save(update_fields=columns)
    close_if_full(stored.contributor.campaign)
    return stored


def _require_changeable(submission: Submission) -> None:
    if submission.contributor.campaign.is_locked:
        raise CampaignOver(has_begun=True)
    if submission.contributor.is_finished or submission.status != SubmissionStatus.PENDING:
        said = "This task is finished. What you wrote is kept."
        raise Refusal(said, "task_finished", HTTPStatus.CONFLICT)


def finish(contributor: Contributor, had_model_help: bool) -> Contributor:
    """End a task, all places of which are answered, with what they say about a language model's help.

    Raises:
        Refusal: a place is empty; ``problems`` has its number.
        CampaignOver: the campaign ended, and the time is up in which those who have begun may finish.
    """
    if not contributor.is_finished and contributor.campaign.is_locked:
        raise CampaignOver(has_begun=True)
    empty = contributor.submissions.filter(text="").order_by("position").first()
    if empty is not None:
        said = f"Number {empty.position} is still empty."
        problem = {"field": "position", "value": empty.position}
        raise Refusal(said, "place_empty", HTTPStatus.CONFLICT, [problem])
    if not contributor.is_finished:
        contributor.finished_at, contributor.had_model_help = timezone.now(), had_model_help
        contributor.save(update_fields=["finished_at", "had_model_help"])
        request_readings(contributor.campaign.world)
    return contributor


def flags_of(submission: Submission, names: Sequence[Named] | None = None) -> Sequence[Flag]:
    """Return the flags of a submission as it stands, compared with what was submitted before it.

    Args:
        names: what a rewrite has to keep; the entities of its prompt unless given.
    """
    if not submission.text:
        return ()
    prompt, contributor = submission.prompt, submission.contributor
    if submission.kind == SubmissionKind.CHECK and prompt is not None:
        return check_flags(submission.text, prompt.check_words)
    own = contributor.submissions.answered().exclude(pk=submission.pk)
    own_texts = tuple(own.exclude(kind=SubmissionKind.CHECK).values_list("text", flat=True))
    if prompt is None:
        shown = contributor.submissions.filter(prompt__isnull=False)
        prompts = tuple(shown.values_list("prompt__shown", flat=True))
        known = KnownWords(prompts)
        command = FreeCommand(submission.text, prompts, own_texts, submission.was_pasted)
        return free_command_flags(command, known.__contains__)
    rewrite = Rewrite(
        submission.text,
        prompt.shown,
        named_in(prompt) if names is None else names,
        submission.seconds,
        submission.was_pasted,
        own_texts,
        _texts_of_others(submission, prompt),
        _texts_of_models(submission, prompt),
    )
    return rewrite_flags(rewrite, KnownWords([prompt.shown, prompt.prompt]).__contains__)


def _texts_of_others(submission: Submission, prompt: CampaignPrompt) -> tuple[str, ...]:
    """Return what others wrote for the same prompt."""
    others = prompt.submissions.answered().exclude(contributor=submission.contributor_id)
    return tuple(others.order_by("pk").values_list("text", flat=True)[:MOST_COMPARED])


def _texts_of_models(submission: Submission, prompt: CampaignPrompt) -> tuple[str, ...]:
    """Return what language models wrote for the same form; nothing for a model's own."""
    if submission.contributor.kind == ContributorKind.MODEL:
        return ()
    by_models = Submission.objects.answered().filter(
        contributor__campaign=submission.contributor.campaign_id,
        contributor__kind=ContributorKind.MODEL,
        prompt__logical_form=prompt.logical_form,
    )
    return tuple(by_models.order_by("pk").values_list("text", flat=True)[:MOST_COMPARED])
