"""The pages of a campaign that its link leads to: for everybody, without an account."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from hashlib import sha256
from http import HTTPStatus

from django import forms
from django.contrib.auth.decorators import login_not_required
from django.core import signing
from django.http import Http404, HttpRequest, HttpResponse, JsonResponse
from django.shortcuts import redirect, render
from django.urls import reverse
from django.views.decorators.cache import never_cache
from django.views.decorators.http import require_http_methods

from annotations.campaigns.answering import finish, save_answer, warnings_for
from annotations.campaigns.limits import TooOften, count_task, require_patience
from annotations.campaigns.pseudonyms import DEVICE, market_id_in, new_device, pseudonym_of
from annotations.campaigns.taboo import taboo_words_for
from annotations.campaigns.tasks import CampaignOver, begin, contributor_of, require_open
from annotations.language.errors import Refusal
from annotations.language.paraphrases import RewriteFault, RewriteWarning
from annotations.models import Campaign, Contributor, Submission
from annotations.models.campaigns import MOST_PLACES
from annotations.models.corpus import MOST_CHARACTERS
from annotations.people.access import READ_AND_WRITE, WRITE
from annotations.people.allowances import only_reads

KNOWN_FOR = 30 * 24 * 3600  # seconds for which a browser is known
LONGEST_LOOK = 24 * 3600  # seconds; who looks at a prompt for longer was away
SHOWN = "annotations.campaigns.shown"  # salts what is signed
ELSEWHERE = "This task was begun in another browser. Go on there: what you wrote is kept."
# What a writer is told; {} is the evidence.
WARNINGS = {
    RewriteFault.TOO_CLOSE: "This is almost what it was. Can you say it in your own words?",
    RewriteFault.TOO_FAR: "This is very different. Does it still ask for the same?",
    RewriteFault.LOST_ENTITY: "“{}” is missing.",
}


@dataclass(frozen=True)
class Visit:
    """A request to a campaign: whose task it is about, None where they have not begun."""

    request: HttpRequest
    campaign: Campaign
    pseudonym: str
    contributor: Contributor | None
    is_known: bool  # by the browser's cookie

    def page(
        self, template: str, status: int = 200, may_remember: bool = True, **context: object
    ) -> HttpResponse:
        """Render a page. The browser is remembered from the first one on, unless it is of somebody else."""
        context |= {"campaign": self.campaign, "contributor": self.contributor}
        name = f"annotations/campaigns/{template}.html"
        response = render(self.request, name, context, status=status)
        return self.remembered(response) if may_remember else response

    def to(self, place: int | str = "") -> HttpResponse:
        """Lead to a place of the task, to its end (``done``), or to the first page."""
        path = reverse("campaign", args=[self.campaign.key])
        return self.remembered(redirect(f"{path}{place}/" if place else path))

    def remembered(self, response: HttpResponse) -> HttpResponse:
        if not self.is_known:
            response.set_signed_cookie(
                cookie_of(self.campaign),
                self.pseudonym,
                max_age=KNOWN_FOR,
                path="/p/",
                httponly=True,
                samesite="Lax",
                secure=self.request.is_secure(),
            )
        return response

    def refusal(self, refusal: Refusal) -> HttpResponse:
        response = self.page("refusal", refusal.status, refusal=refusal.message)
        if refusal.wait:
            response["Retry-After"] = str(refusal.wait)
        return response


View = Callable[..., HttpResponse]


def cookie_of(campaign: Campaign) -> str:
    return f"campaign_{campaign.pk}"


def public_view(methods: tuple[str, ...]) -> Callable[[View], View]:
    """Return a view at ``/p/<key>/…`` for whoever has the link; it receives a ``Visit``.

    A browser is known by a signed cookie, and a new one by the id that a crowd market sends in the address.
    That id alone never leads to what somebody has written.
    """

    def decorate(view: View) -> View:
        @wraps(view)
        def guarded(request: HttpRequest, key: str, **kwargs: int) -> HttpResponse:
            campaign = Campaign.objects.for_key(key)
            if campaign is None:
                said = "No campaign has this link. Ask whoever sent it to you for another one."
                context = {"refusal": said}
                return render(request, "annotations/campaigns/refusal.html", context, status=404)
            visit = visit_to(campaign, request)
            if visit.contributor is not None and not visit.is_known:
                return visit.page(
                    "refusal", HTTPStatus.CONFLICT, may_remember=False, refusal=ELSEWHERE
                )
            try:
                return view(visit, **kwargs)
            except Refusal as refusal:
                return visit.refusal(refusal)

        return login_not_required(never_cache(require_http_methods(methods)(guarded)))

    return decorate


def visit_to(campaign: Campaign, request: HttpRequest) -> Visit:
    known = request.get_signed_cookie(cookie_of(campaign), "", max_age=KNOWN_FOR)
    market = market_id_in(request.GET)
    if known and (market is None or contributor_of(campaign, known)):
        return Visit(request, campaign, known, contributor_of(campaign, known), True)
    pseudonym = pseudonym_of(campaign, *(market or (DEVICE, new_device())))
    contributor = contributor_of(campaign, pseudonym)
    return Visit(request, campaign, pseudonym, contributor, known == pseudonym)


@public_view(READ_AND_WRITE)
def campaign_begin(visit: Visit) -> HttpResponse:
    """Say what the campaign is about, and begin a task for whoever agrees."""
    contributor, campaign = visit.contributor, visit.campaign
    may_retake = campaign.allows_retake and not campaign.is_over
    has_to_begin = contributor is None or (contributor.is_finished and may_retake)
    if has_to_begin:
        require_open(campaign)
    elif contributor and not contributor.is_finished and campaign.is_locked:
        raise CampaignOver(has_begun=True)
    digest = sha256(campaign.consent.encode()).hexdigest()[:16]
    if visit.request.method != "POST":
        if market_id_in(visit.request.GET):
            return visit.to()  # the id leaves the address, and with it every log of it
        return visit.page("begin", has_to_begin=has_to_begin, consent_digest=digest)
    if has_to_begin:
        missing = ""
        if not visit.request.POST.get("agrees"):
            missing = "Tick the box to begin: without your consent nothing is stored."
        elif visit.request.POST.get("consent", digest) != digest:
            missing = "This text was changed while you read it. Read it again, then tick the box."
        if missing:
            return visit.page(
                "begin", 422, has_to_begin=True, missing=missing, consent_digest=digest
            )
        count_task(str(visit.request.META["REMOTE_ADDR"]))
        contributor = begin(campaign, visit.pseudonym)
    assert contributor is not None
    return visit.to(next_place(contributor))


@public_view(READ_AND_WRITE)
def campaign_place(visit: Visit, position: int) -> HttpResponse:
    """Show one place of the task; save what is written there and lead to the next one."""
    place = place_of(visit, position)
    if place is None:
        return visit.to()
    if place.contributor.is_finished:
        return visit.to("done")
    if visit.campaign.is_locked:
        raise CampaignOver(has_begun=True)
    request = visit.request
    if request.method != "POST":
        return show_place(visit, place)
    form = AnswerForm(request.POST)
    if not form.is_valid():
        return show_place(visit, place, form, status=422)
    text = form.cleaned_data["text"]
    try:
        require_patience(place.contributor)
    except TooOften as refusal:
        form.add_error("text", refusal.message)
        response = show_place(visit, place, form, refusal.status)
        response["Retry-After"] = str(refusal.wait)
        return response
    seconds = seconds_since(form.cleaned_data["shown"], place)
    save_answer(place, text, seconds, was_pasted=form.cleaned_data["pasted"])
    # Whoever has not seen the advice while writing gets it now, once.
    if not form.cleaned_data["advised"] and warnings_for(place, text):
        return visit.remembered(redirect(f"{request.path}?advice=1"))
    return visit.to(position + 1 if position < place.contributor.submissions.count() else "done")


@only_reads
@public_view(WRITE)
def campaign_check(visit: Visit, position: int) -> HttpResponse:
    """Answer, as JSON, what to tell the writer of a text; nothing is stored."""
    place = place_of(visit, position)
    text = visit.request.POST.get("text", "")[:MOST_CHARACTERS]
    warnings = () if place is None else warnings_for(place, text)
    told = [{"code": each.code, "sentence": sentence_of(each)} for each in warnings]
    return JsonResponse({"warnings": told})


@public_view(READ_AND_WRITE)
def campaign_done(visit: Visit) -> HttpResponse:
    """Ask at the end whether a language model helped; then thank, with the code for a crowd market."""
    contributor = visit.contributor
    if contributor is None:
        return visit.to()
    if not contributor.is_finished and visit.campaign.is_locked:
        raise CampaignOver(has_begun=True)
    empty = contributor.submissions.filter(text="").order_by("position").first()
    if empty is not None:
        return visit.to(empty.position)
    if visit.request.method == "POST" and not contributor.is_finished:
        helped = visit.request.POST.get("helped")
        if helped not in ("yes", "no"):
            missing = "Choose one of the two: both are fine to say."
            return visit.page("done", 422, missing=missing, size=contributor.submissions.count())
        finish(contributor, helped == "yes")
        return visit.to("done")
    return visit.page("done", size=contributor.submissions.count())


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
    visit: Visit, place: Submission, form: AnswerForm | None = None, status: int = 200
) -> HttpResponse:
    size = place.contributor.submissions.count()
    wants_advice = "advice" in visit.request.GET and form is None
    return visit.page(
        "place",
        status,
        place=place,
        size=size,
        text=place.text if form is None else form.data.get("text", ""),
        errors=[] if form is None else form.errors.get("text", []),
        warnings=[sentence_of(each) for each in warnings_for(place, place.text)]
        if wants_advice
        else [],
        taboo=taboo_words_for(place),
        shown=signing.dumps([place.pk, time.time()], salt=SHOWN),
        most_characters=MOST_CHARACTERS,
    )


def place_of(visit: Visit, position: int) -> Submission | None:
    """Return a place of the task; None where it has none of that number, or was not begun."""
    if position > MOST_PLACES:
        raise Http404("No task has so many places.")
    if visit.contributor is None:
        return None
    places = visit.contributor.submissions.select_related("prompt", "contributor__campaign")
    return places.filter(position=position).first()


def next_place(contributor: Contributor) -> int | str:
    """Return the number of the first empty place, ``done`` without one."""
    empty = contributor.submissions.filter(text="").order_by("position").first()
    return "done" if empty is None else empty.position


def sentence_of(warning: RewriteWarning) -> str:
    return WARNINGS[warning.code].format(warning.evidence)


def seconds_since(shown: str, place: Submission) -> float | None:
    """Return how long the place has been looked at; None where that was not signed for it."""
    try:
        key, moment = signing.loads(shown, salt=SHOWN, max_age=LONGEST_LOOK)
    except signing.BadSignature:
        return None
    return round(time.time() - moment, 1) if key == place.pk else None
