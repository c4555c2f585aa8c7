"""The pages of a campaign that its link leads to: for everybody, without an account."""

from __future__ import annotations

import time
from dataclasses import replace
from hashlib import sha256
from typing import Any
from urllib.parse import quote

from django import forms
from django.core import signing
from django.http import Http404, HttpResponse, JsonResponse
from django.utils import timezone

from annotations.campaigns.answering import finish, save_answer, warnings_for
from annotations.campaigns.limits import TooOften, count_task, require_patience
from annotations.campaigns.pseudonyms import ASSIGNMENT_IDS
from annotations.campaigns.taboo import taboo_words_for
from annotations.campaigns.tasks import CampaignOver, begin, require_open
from annotations.language.corpus import RewriteFault, RewriteWarning
from annotations.language.texts import say_count
from annotations.models import Campaign, Submission
from annotations.models.campaigns import MOST_PLACES
from annotations.models.corpus import MOST_CHARACTERS
from annotations.people.access import READ_AND_WRITE, WRITE
from annotations.people.allowances import only_reads
from annotations.web.campaigns.visits import Visit, public_view

LONGEST_LOOK = 24 * 3600  # seconds; who looks at a prompt for longer was away
SHOWN = "annotations.campaigns.shown"  # salts what is signed
# What a writer is told; {} is the evidence.
WARNINGS = {
    RewriteFault.TOO_CLOSE: "This is almost what it was. Can you say it in your own words?",
    RewriteFault.TOO_FAR: "This is very different. Does it still ask for the same?",
    RewriteFault.LOST_ENTITY: "“{}” is missing.",
}


@public_view(READ_AND_WRITE)
def campaign_begin(visit: Visit) -> HttpResponse:
    """Say what the campaign is about, and begin a task for whoever agrees."""
    contributor, campaign = visit.contributor, visit.campaign
    if contributor is None and visit.visitor.is_screened_out:
        return show_screened_out(visit)
    may_retake = campaign.allows_retake and not campaign.is_over
    has_to_begin = visit.is_preview or contributor is None
    has_to_begin = has_to_begin or bool(contributor and contributor.is_finished and may_retake)
    if has_to_begin:
        require_open(campaign)
    elif contributor and not contributor.is_finished and campaign.is_locked:
        raise CampaignOver(has_begun=True)
    if visit.request.method != "POST":
        return show_begin(visit, has_to_begin)
    if has_to_begin:
        sent, missing = visit.request.POST, {}
        if campaign.screening_question and sent.get("fits") == "no":
            return show_screened_out(
                replace(visit, visitor=replace(visit.visitor, is_screened_out=True))
            )
        if campaign.screening_question and sent.get("fits") != "yes":
            missing["fits"] = "Choose one of the two."
        if not sent.get("agrees"):
            missing["agrees"] = "Tick the box to begin: without your consent nothing is stored."
        elif sent.get("consent", digest := consent_digest(campaign)) != digest:
            missing["agrees"] = (
                "This text was changed while you read it. Read it again, then tick the box."
            )
        if missing:
            return show_begin(visit, has_to_begin, missing)
        if visit.is_preview:
            return visit.to(1)
        count_task(str(visit.request.META["REMOTE_ADDR"]))
        contributor = begin(campaign, visit.visitor.pseudonym)
        visit = replace(visit, contributor=contributor)
    return visit.to(next_place(visit))


def show_begin(
    visit: Visit, has_to_begin: bool, missing: dict[str, str] | None = None
) -> HttpResponse:
    return visit.page(
        "begin",
        422 if missing else 200,
        has_to_begin=has_to_begin,
        missing=missing,
        facts=facts_of(visit.campaign),
        consent_digest=consent_digest(visit.campaign),
    )


def show_screened_out(visit: Visit) -> HttpResponse:
    """Thank whoever does not fit, with what the market wants of them. Nothing of them is stored."""
    campaign = visit.campaign
    handing_in = way_back(visit, campaign.screened_out_code, campaign.screened_out_url)
    return visit.page("screened_out", **handing_in)


def facts_of(campaign: Campaign) -> list[tuple[str, str]]:
    """Return what somebody wants to know before they agree, as names and values."""
    size = f"{say_count(campaign.task_size, 'command')} to say in your own words"
    if campaign.checks:
        size += f", {say_count(campaign.checks, 'short check')}"
    if campaign.free_commands:
        size += f", {say_count(campaign.free_commands, 'command')} of your own"
    pay = "none" if campaign.price is None else f"{campaign.price} {campaign.currency}".strip()
    facts = [
        ("How much", size),
        ("How long", f"about {say_count(campaign.expected_minutes, 'minute')}"),
        ("Payment", pay),
        ("Who runs it", campaign.run_by),
        ("Questions to", campaign.contact),
    ]
    return [(name, value) for name, value in facts if value]


def consent_digest(campaign: Campaign) -> str:
    """Return a hash of all that somebody agrees to."""
    return sha256(repr((campaign.consent, facts_of(campaign))).encode()).hexdigest()[:16]


@public_view(READ_AND_WRITE)
def campaign_place(visit: Visit, position: int) -> HttpResponse:
    """Show one place of the task; save what is written there and lead to the next one."""
    places = places_of(visit, position)
    if not 0 < position <= len(places):
        return visit.to()
    place = places[position - 1]
    if place.contributor.is_finished:
        return visit.to("done")
    if visit.campaign.is_locked:
        raise CampaignOver(has_begun=True)
    if not visit.may_see(place):
        return visit.to(next_place(visit))
    request = visit.request
    if request.method != "POST":
        return show_place(visit, places, position)
    form = AnswerForm(request.POST)
    if not form.is_valid():
        return show_place(visit, places, position, form, status=422)
    if not visit.is_preview:
        text = form.cleaned_data["text"]
        try:
            require_patience(place.contributor)
        except TooOften as refusal:
            form.add_error("text", refusal.message)
            response = show_place(visit, places, position, form, refusal.status)
            response["Retry-After"] = str(refusal.wait)
            return response
        seconds = seconds_since(form.cleaned_data["shown"], place)
        was_pasted = form.cleaned_data["pasted"]
        save_answer(place, text, seconds, was_pasted, visit.visitor.browser)
        # Whoever has not seen the advice while writing gets it now, once.
        if not form.cleaned_data["advised"] and warnings_for(place, text):
            return visit.to(position, advice="1")
    following = (each.position for each in places[position:] if visit.may_see(each))
    return visit.to(next(following, "done"))


@only_reads
@public_view(WRITE)
def campaign_check(visit: Visit, position: int) -> HttpResponse:
    """Answer, as JSON, what to tell the writer of a text; nothing is stored."""
    places = places_of(visit, position)
    text = visit.request.POST.get("text", "")[:MOST_CHARACTERS]
    warnings = warnings_for(places[position - 1], text) if 0 < position <= len(places) else ()
    told = [{"code": each.code, "sentence": sentence_of(each)} for each in warnings]
    return JsonResponse({"warnings": told})


@public_view(READ_AND_WRITE)
def campaign_done(visit: Visit) -> HttpResponse:
    """Ask at the end whether a language model helped; then thank, with the code for a crowd market."""
    contributor, request = visit.contributor, visit.request
    if contributor is None:
        return visit.to()
    if visit.is_preview:
        if request.method == "POST":
            contributor.finished_at = timezone.now()
        return show_done(visit)
    if not contributor.is_finished and visit.campaign.is_locked:
        raise CampaignOver(has_begun=True)
    if (place := next_place(visit)) != "done":
        return visit.to(place)
    if request.method == "POST" and not contributor.is_finished:
        helped = request.POST.get("helped")
        if helped not in ("yes", "no"):
            return show_done(visit, "Choose one of the two: both are fine to say.")
        finish(contributor, helped == "yes")
        return visit.to("done")
    return show_done(visit)


def show_done(visit: Visit, missing: str = "") -> HttpResponse:
    """Show the last question, or the thanks. A preview has no code, for it is for everybody."""
    campaign = visit.campaign
    code = campaign.completion_code
    if visit.is_preview and code:
        code = "the code stands here"
    return visit.page(
        "done",
        422 if missing else 200,
        missing=missing,
        back=previous_address(visit, visit.places()),
        **way_back(visit, code, campaign.return_url),
    )


def way_back(visit: Visit, code: str, address: str) -> dict[str, Any]:
    """Return what takes somebody back to where they came from: a code, and a link or a form.

    In the frame of a market that names the assignment, a form posts it: that ends a task of Mechanical Turk.
    """
    assignment = visit.visitor.assignment
    name = visit.campaign.assignment_parameter or ASSIGNMENT_IDS[0]
    is_posted = visit.is_carried and assignment and "{assignment}" not in address
    return {
        "code": code,
        "return_address": address.replace("{assignment}", quote(assignment, safe="")),
        "handed_in": {
            name: assignment,
            "code": code,
            "contributor": visit.visitor.pseudonym,
        }
        if is_posted
        else {},
    }


class AnswerForm(forms.Form):
    """What is written at a place. ``shown`` says, signed, since when it is looked at."""

    text = forms.CharField(
        max_length=MOST_CHARACTERS,
        error_messages={
            "required": "Write something here.",
            "max_length": f"Use at most {MOST_CHARACTERS} characters.",
        },
    )
    shown = forms.CharField(required=False, max_length=200)
    pasted = forms.BooleanField(required=False)
    advised = forms.BooleanField(required=False)


def show_place(
    visit: Visit,
    places: list[Submission],
    position: int,
    form: AnswerForm | None = None,
    status: int = 200,
) -> HttpResponse:
    place = places[position - 1]
    wants_advice = "advice" in visit.request.GET and form is None
    return visit.page(
        "place",
        status,
        place=place,
        size=len(places),
        text=place.text if form is None else form.data.get("text", ""),
        errors=[] if form is None else form.errors.get("text", []),
        warnings=[sentence_of(each) for each in warnings_for(place, place.text)]
        if wants_advice
        else [],
        taboo=taboo_words_for(place),
        shown=signing.dumps([place.pk, time.time()], salt=SHOWN),
        most_characters=MOST_CHARACTERS,
        here=visit.address(position),
        advises=visit.address(f"{position}/check"),
        back=previous_address(visit, places[: position - 1]),
    )


def places_of(visit: Visit, position: int) -> list[Submission]:
    """Return the places of the task; none before it was begun."""
    if position > MOST_PLACES:
        raise Http404("No task has so many places.")
    return visit.places()


def next_place(visit: Visit) -> int | str:
    """Return the number of the first empty place, ``done`` without one."""
    empty = (place.position for place in visit.places() if not place.text)
    return next(empty, "done")


def previous_address(visit: Visit, places: list[Submission]) -> str:
    """Return the address of the last of ``places`` whose text may be seen here, or of the first page."""
    seen = (place.position for place in reversed(places) if visit.may_see(place))
    return visit.address(next(seen, ""))


def sentence_of(warning: RewriteWarning) -> str:
    return WARNINGS[warning.code].format(warning.evidence)


def seconds_since(shown: str, place: Submission) -> float | None:
    """Return how long the place has been looked at; None where that was not signed for it."""
    try:
        key, moment = signing.loads(shown, salt=SHOWN, max_age=LONGEST_LOOK)
    except signing.BadSignature:
        return None
    return round(time.time() - moment, 1) if key == place.pk else None
