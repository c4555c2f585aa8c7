"""What contributors have submitted, and deciding about it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from http import HTTPStatus

from django import forms
from django.contrib import messages
from django.db.models import Exists, OuterRef
from django.http import HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import reverse
from django.utils.dateparse import parse_datetime

from annotations.campaigns.moderation import (
    MOST_AT_ONCE,
    accept,
    accept_with_doubt,
    accept_with_form,
    mend,
    reject,
    take_back_moderation,
)
from annotations.labelling.proposal_requests import request_readings
from annotations.language.corpus import FlagCode
from annotations.language.texts import Refusal, say_count
from annotations.models import Contributor, Duty, Submission, User, World
from annotations.models.campaigns import SubmissionKind, SubmissionQuerySet, SubmissionStatus
from annotations.models.corpus import MOST_CHARACTERS
from annotations.models.queueing import LONGEST_REASON
from annotations.people.access import WRITE, WorldRequest, world_view
from annotations.people.allowances import may_take_long
from annotations.showing.keys import keys_for
from annotations.showing.listing import Listing, Sort, count_some, render_list
from annotations.showing.paging import number_in
from annotations.web.campaigns.submission_filters import SubmissionFilters
from annotations.web.editing.undo import say_with_undo

SORTS = {
    "number": Sort("No.", "id", is_number=True),
    "text": Sort("Submission", "text"),
    "status": Sort("Status", "status"),
}
KEYS_OF_LIST = keys_for("tick", "accept", "reject", "undo")
PAGE_KEYS = keys_for("next", "previous", "accept", "reject", "mend", "edit", "dispute", "undo")
OTHERS_SHOWN = 30  # of the same contributor


class DecisionForm(forms.Form):
    """A decision about one submission, with what it needs."""

    decision = forms.ChoiceField(
        choices=[(each, each) for each in ("accept", "reject", "mend", "form", "doubt", "undo")]
    )
    text = forms.CharField(required=False, max_length=MOST_CHARACTERS)
    form = forms.CharField(required=False, max_length=4_000)
    reason = forms.CharField(required=False, max_length=LONGEST_REASON)


def submissions_of(world: World) -> SubmissionQuerySet:
    """Return what was answered in a world, planted checks left out."""
    # Not by a join, so that a page of them is read in their order, and no further.
    theirs = Contributor.objects.filter(pk=OuterRef("contributor"), campaign__world=world)
    rows = Submission.objects.filter(Exists(theirs)).answered()
    related = ("contributor__campaign", "prompt", "decided_by")
    return rows.exclude(kind=SubmissionKind.CHECK).select_related(*related)


@world_view(Duty.REVIEW)
def submissions(request: WorldRequest, world: World) -> HttpResponse:
    """List what contributors wrote, with its flags."""
    listing = Listing(request, SubmissionFilters, submissions_of(world), SORTS)
    context = {
        "listing": listing,
        "page_keys": KEYS_OF_LIST,
        "n_waiting": count_some(submissions_of(world).awaiting_moderation()),
    }
    return render_list(request, "annotations/campaigns/submissions.html", context)


@world_view(Duty.REVIEW)
def submission(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show one submission beside its prompt, and what else its contributor wrote."""
    row = get_object_or_404(submissions_of(world), pk=pk)
    return _show(request, row)


@world_view(Duty.REVIEW, WRITE, does="moderate submissions")
def submission_decide(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Decide about one submission, or mend its text."""
    row = get_object_or_404(submissions_of(world), pk=pk)
    form = DecisionForm(request.POST)
    if not form.is_valid():
        sentence = " ".join(str(each) for errors in form.errors.values() for each in errors)
        return _show(request, row, sentence)
    sent = form.cleaned_data
    try:
        match sent["decision"]:
            case "mend":
                mend(row, sent["text"])
                messages.success(request, "The text is mended. What was written is kept beside it.")
                return redirect("submission", world=world.name, pk=row.pk)
            case "undo":
                take_back_moderation(row, request.user)
                messages.success(request, "The decision is undone. It waits again.")
                return redirect("submission", world=world.name, pk=row.pk)
            case "form":
                accept_with_form(row, sent["form"], request.user)
            case "doubt":
                accept_with_doubt(row, sent["reason"] or "the form may be another", request.user)
            case decision:
                verb = accept if decision == "accept" else reject
                if not verb([row], request.user):
                    messages.warning(request, "Somebody has decided about this already.")
                    return redirect("submission", world=world.name, pk=row.pk)
    except Refusal as refusal:
        return _show(request, row, str(refusal), HTTPStatus.UNPROCESSABLE_ENTITY)
    row.refresh_from_db()
    request_readings(world)
    _say_decided(request, world, [row])
    return _to_the_next(world, row)


@may_take_long
@world_view(Duty.REVIEW, WRITE, does="moderate submissions")
def submissions_decide(request: WorldRequest, world: World) -> HttpResponse:
    """Accept or reject the submissions that are ticked."""
    verbs: dict[str, Callable[[Sequence[Submission], User], int]] = {
        "accept": accept,
        "reject": reject,
    }
    verb = verbs.get(request.POST.get("decision", ""))
    keys = [number_in(each) for each in request.POST.getlist("row")][:MOST_AT_ONCE]
    rows = list(submissions_of(world).awaiting_moderation().filter(pk__in=keys))
    if verb is None or not rows:
        messages.warning(request, "Tick submissions that wait, then choose what becomes of them.")
    else:
        verb(rows, request.user)
        request_readings(world)
        _say_decided(request, world, rows)
    return redirect(f"{reverse('submissions', args=[world.name])}?status=pending")


@may_take_long
@world_view(Duty.REVIEW, WRITE, does="take back a moderation")
def submissions_take_back(request: WorldRequest, world: World) -> HttpResponse:
    """Undo what somebody decided at one moment: the time that was sent as ``at``."""
    try:
        at = parse_datetime(request.POST.get("at", "")[:40])
    except ValueError:
        at = None
    decided = submissions_of(world).filter(
        decided_by=request.user, decided_at=at if at and at.tzinfo else None
    )
    taken_back, refused = 0, ""
    for row in decided.exclude(status=SubmissionStatus.PENDING)[:MOST_AT_ONCE]:
        try:
            take_back_moderation(row, request.user)
        except Refusal as refusal:
            refused = str(refusal)
        else:
            taken_back += 1
    if taken_back:
        wait = "waits" if taken_back == 1 else "wait"
        messages.success(request, f"{say_count(taken_back, 'submission')} {wait} again.")
    if refused or not taken_back:
        messages.warning(request, refused or "There is nothing to undo.")
    return redirect(f"{reverse('submissions', args=[world.name])}?status=pending")


def _show(request: WorldRequest, row: Submission, error: str = "", status: int = 0) -> HttpResponse:
    others = row.contributor.submissions.answered().exclude(pk=row.pk).select_related("prompt")
    waiting = submissions_of(row.contributor.campaign.world).awaiting_moderation().order_by("pk")
    context = {
        "row": row,
        "before": waiting.filter(pk__lt=row.pk).values_list("pk", flat=True).last(),
        "after": waiting.filter(pk__gt=row.pk).values_list("pk", flat=True).first(),
        "other_form": next(
            (flag["evidence"] for flag in row.flags if flag["code"] == FlagCode.OTHER_FORM), ""
        ),
        "error": error,
        "page_keys": PAGE_KEYS,
        "others": others[:OTHERS_SHOWN],
        "sent": request.POST,
        "most_characters": MOST_CHARACTERS,
        "longest_reason": LONGEST_REASON,
    }
    code = status or (HTTPStatus.UNPROCESSABLE_ENTITY if error else HTTPStatus.OK)
    return render(request, "annotations/campaigns/submission.html", context, status=code)


def _say_decided(request: WorldRequest, world: World, rows: Sequence[Submission]) -> None:
    first = Submission.objects.get(pk=rows[0].pk)
    assert first.decided_at is not None
    undo = reverse("submissions_take_back", kwargs={"world": world.name})
    sentence = f"{say_count(len(rows), 'submission')} {first.status}."
    say_with_undo(request, sentence, undo, at=first.decided_at.isoformat())


def _to_the_next(world: World, row: Submission) -> HttpResponse:
    """Lead to the next submission of the campaign that waits; to the list without one."""
    waiting = submissions_of(world).awaiting_moderation()
    campaign = waiting.filter(contributor__campaign=row.contributor.campaign_id)
    following = campaign.filter(pk__gt=row.pk).order_by("pk").first() or campaign.first()
    if following is None:
        return redirect(f"{reverse('submissions', args=[world.name])}?status=pending")
    return redirect("submission", world=world.name, pk=following.pk)
