"""Verbs: decide about submissions. What is accepted becomes a paraphrase, or an utterance to be labelled."""

from __future__ import annotations

from collections.abc import Sequence
from http import HTTPStatus

from django.db import transaction
from django.utils import timezone

from annotations.campaigns.answering import named_in
from annotations.editing.edits import add_many, delete
from annotations.labelling.audit_findings import doubt
from annotations.labelling.collecting import collect, find_known
from annotations.labelling.form_check import canonical_label
from annotations.labelling.utterance_deletion import delete_utterances
from annotations.language.corpus import FlagCode, distance, lost_entities
from annotations.language.forms import canonical_text, read_form
from annotations.language.grounding import ground_like
from annotations.language.texts import Position, Refusal, normalise_line, require_writable
from annotations.models import (
    Origin,
    Paraphrase,
    Submission,
    User,
    Utterance,
    UtteranceStatus,
    World,
)
from annotations.models.campaigns import SubmissionKind, SubmissionStatus
from annotations.models.corpus import MOST_CHARACTERS

MOST_AT_ONCE = 500  # submissions of one decision: the world is held meanwhile


class DecidedAlready(Refusal):
    """Somebody has decided about a submission in the meantime."""

    code = "decided_already"
    status = HTTPStatus.CONFLICT

    def __init__(self) -> None:
        super().__init__("Somebody has decided about this already. Look at it again.")


def accept(submissions: Sequence[Submission], by: User) -> int:
    """Accept submissions of one world that nobody has decided about, and return how many there were.

    A rewrite becomes an accepted paraphrase with the form of its prompt; a free command becomes an utterance,
    which waits to be labelled. Planted checks and empty places are left out.

    Raises:
        Refusal: there are more than ``MOST_AT_ONCE``.
    """
    with transaction.atomic():
        rows = _hold(submissions)
        rewrites = [row for row in rows if row.kind == SubmissionKind.REWRITE]
        paraphrases = [paraphrase_from(row) for row in rewrites]
        add_many(paraphrases, by)
        for row, paraphrase in zip(rewrites, paraphrases, strict=True):
            row.paraphrase = paraphrase
        _collect_free_commands([row for row in rows if row.kind == SubmissionKind.FREE], by)
        _decide(rows, SubmissionStatus.ACCEPTED, by)
    return len(rows)


def reject(submissions: Sequence[Submission], by: User) -> int:
    """Reject submissions of one world that nobody has decided about, and return how many there were."""
    with transaction.atomic():
        rows = _hold(submissions)
        _decide(rows, SubmissionStatus.REJECTED, by)
    return len(rows)


def take_back_moderation(submission: Submission, by: User) -> Submission:
    """Undo a decision: the submission waits again, and what was made of it goes.

    Raises:
        Refusal: nothing was decided, or somebody has worked with what was made of it.
    """
    with transaction.atomic():
        (row,) = _held([submission])
        if row.status == SubmissionStatus.PENDING:
            raise Refusal("Nothing was decided about this.", "not_decided", HTTPStatus.CONFLICT)
        if row.paraphrase is not None:
            if row.paraphrase.version > 1:
                raise Refusal(
                    "The paraphrase was edited since. Delete it on its page instead.",
                    "edited_since",
                    HTTPStatus.CONFLICT,
                )
            delete(row.paraphrase, by, row.paraphrase.version)
            row.paraphrase = None
        if row.utterance is not None:
            heir = heir_of(row)
            if heir is None and row.utterance.status != UtteranceStatus.UNLABELLED:
                raise Refusal(
                    "The utterance was labelled since. Delete it on its page instead.",
                    "labelled_since",
                    HTTPStatus.CONFLICT,
                )
            hand_on(row, heir)
            if heir is None:
                delete_utterances([row.utterance.pk], by)
            row.utterance = None
        row.status, row.decided_by, row.decided_at = SubmissionStatus.PENDING, None, None
        row.save(update_fields=["status", "decided_by", "decided_at", "paraphrase", "utterance"])
    return row


def mend(submission: Submission, text: str) -> Submission:
    """Correct a typing error before deciding; ``raw`` keeps what was written.

    Raises:
        Refusal: the text is empty, too long or no text, or somebody has decided about it.
    """
    wanted = normalise_line(text)
    require_writable(wanted, Position())
    if not wanted or len(wanted) > MOST_CHARACTERS:
        said = f"Write between 1 and {MOST_CHARACTERS} characters."
        raise Refusal(said, "too_long" if wanted else "empty")
    with transaction.atomic():
        (row,) = _held([submission])
        if row.status != SubmissionStatus.PENDING:
            raise DecidedAlready
        if wanted != row.text:
            row.raw = row.raw or row.text
            row.text = wanted
            names = named_in(row.prompt) if row.prompt else ()
            lost = ", ".join(lost_entities(wanted, names))
            told_anew = (FlagCode.LOST_ENTITY, FlagCode.OTHER_FORM)
            row.flags = [flag for flag in row.flags if flag["code"] not in told_anew]
            if lost:
                row.flags.append({"code": FlagCode.LOST_ENTITY, "evidence": lost})
            row.read_by_run = None
            row.save(update_fields=["raw", "text", "flags", "read_by_run"])
    return row


def accept_with_form(submission: Submission, form: str, by: User) -> Submission:
    """Accept a rewrite that asks for something else than its prompt, with the form of what it does ask for.

    Args:
        form: anonymized, in any of the notations. The grounded form has the entities of the prompt where they
            are certain.

    Raises:
        LanguageError: the form cannot be read.
        Refusal: it is no rewrite, or somebody has decided about it.
    """
    label = canonical_label(form)
    with transaction.atomic():
        (row,) = _held([submission])
        if row.status != SubmissionStatus.PENDING:
            raise DecidedAlready
        if row.kind != SubmissionKind.REWRITE:
            raise Refusal("Only a rewrite has a form here. Label a free command.", "no_rewrite")
        paraphrase = paraphrase_from(row)
        before = map(read_form, (paraphrase.logical_form, paraphrase.grounded_form))
        paraphrase.logical_form = label
        paraphrase.grounded_form = canonical_text(ground_like(read_form(label), *before))
        paraphrase.command, paraphrase.command_text = None, ""
        add_many([paraphrase], by)
        row.paraphrase = paraphrase
        _decide([row], SubmissionStatus.ACCEPTED, by)
    return row


def accept_with_doubt(submission: Submission, reason: str, by: User) -> Submission:
    """Accept a rewrite and put its label among those that an audit doubts.

    Raises:
        Refusal: it is no rewrite, or somebody has decided about it.
    """
    with transaction.atomic():
        if submission.kind != SubmissionKind.REWRITE:
            raise Refusal("Only a rewrite has a label here.", "no_rewrite")
        if not accept([submission], by):
            raise DecidedAlready
        (row,) = _held([submission])
        assert row.paraphrase is not None
        doubt(row.paraphrase, reason, by)
    return row


def paraphrase_from(submission: Submission) -> Paraphrase:
    """Return the unsaved paraphrase that a rewrite becomes."""
    prompt = submission.prompt
    assert prompt is not None
    apart = distance(submission.text, prompt.prompt)
    return Paraphrase(
        world=submission.contributor.campaign.world,
        command=prompt.command,
        prompt=prompt.prompt,
        utterance=submission.text,
        grounded_form=prompt.grounded_form,
        logical_form=prompt.logical_form,
        edit_distance=apart.edit,
        jaccard_distance=apart.jaccard,
        contributor=submission.contributor,
    )


def _collect_free_commands(rows: Sequence[Submission], by: User) -> None:
    """Make utterances of free commands. One that is here already is not theirs: somebody else brought it."""
    if not rows:
        return
    world = rows[0].contributor.campaign.world
    texts = [row.text for row in rows]
    known = find_known(world, texts)
    collect(world, texts, Origin.CONTRIBUTOR, by)
    made = Utterance.objects.filter(world=world, text__in=set(texts) - known)
    free = {each.text: each for each in made.filter(submission__isnull=True)}
    for row in rows:
        row.utterance = free.pop(row.text, None)


def heir_of(submission: Submission) -> Submission | None:
    """Return another accepted free command with the same text, whose utterance that of ``submission`` can become."""
    others = Submission.objects.filter(
        contributor__campaign__world=submission.contributor.campaign.world_id,
        kind=SubmissionKind.FREE,
        status=SubmissionStatus.ACCEPTED,
        text=submission.text,
        utterance__isnull=True,
    ).exclude(contributor=submission.contributor_id)
    return others.order_by("pk").first()


def hand_on(submission: Submission, heir: Submission | None) -> None:
    """Give the utterance of ``submission`` to ``heir``, if there is one."""
    if heir is None:
        return
    utterance = submission.utterance
    Submission.objects.filter(pk=submission.pk).update(utterance=None)
    Submission.objects.filter(pk=heir.pk).update(utterance=utterance)


def _hold(submissions: Sequence[Submission]) -> list[Submission]:
    """Lock those of ``submissions`` about which somebody may decide now."""
    if len(submissions) > MOST_AT_ONCE:
        raise Refusal(f"Decide about at most {MOST_AT_ONCE:,} at once.", "too_many")
    return [
        row
        for row in _held(submissions)
        if row.status == SubmissionStatus.PENDING and row.text and row.kind != SubmissionKind.CHECK
    ]


def _held(submissions: Sequence[Submission]) -> list[Submission]:
    keys = [each.pk for each in submissions]
    rows = Submission.objects.filter(pk__in=keys).order_by("pk")
    if worlds := set(rows.values_list("contributor__campaign__world", flat=True)):
        # The world first, as whoever edits something in it does: nobody waits for the other then.
        World.objects.hold().get(pk=worlds.pop())
    related = ("contributor__campaign__world", "prompt__command", "paraphrase", "utterance")
    return list(rows.select_for_update(of=("self",)).select_related(*related))


def _decide(rows: Sequence[Submission], status: str, by: User) -> None:
    now = timezone.now()
    for row in rows:
        row.status, row.decided_by, row.decided_at = status, by, now
    columns = ["status", "decided_by", "decided_at", "paraphrase", "utterance"]
    Submission.objects.bulk_update(rows, columns, batch_size=200)
