"""Who comes to the public pages of a campaign, and how they are known there again.

A browser is known by a signed cookie. A page in the frame of a crowd market gets no cookie: there the same signed words
stand in the address, as ``visit``. With them nobody needs a cookie against forged posts either, for no other site
knows them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import wraps
from typing import Any
from urllib.parse import urlencode

from csp.decorators import csp_replace, csp_update
from django.contrib.auth.decorators import login_not_required
from django.core import signing
from django.http import HttpRequest, HttpResponse
from django.shortcuts import redirect, render
from django.urls import reverse
from django.views.decorators.cache import never_cache
from django.views.decorators.csrf import csrf_exempt, csrf_protect

from annotations.campaigns.addresses import origin_of
from annotations.campaigns.pseudonyms import (
    DEVICE,
    NOT_ACCEPTED,
    assignment_in,
    market_id_in,
    new_device,
    pseudonym_of,
)
from annotations.campaigns.tasks import contributor_of, preview_places
from annotations.language.texts import Refusal
from annotations.models import Campaign, Contributor, Submission
from annotations.people.access import NOTHING, plain_view

KNOWN_FOR = 30 * 24 * 3600  # seconds for which a browser is known
VISITOR = "annotations.campaigns.visitor"  # salts what is signed
VISIT, PREVIEW = "visit", "preview"
OWN_PARAMETERS = {VISIT, "advice"}
FRAMES = ("iframe", "frame")


@dataclass(frozen=True)
class Visitor:
    """What a browser keeps: a random number of its own, whose task it does, and the market's id of that."""

    browser: str
    pseudonym: str
    assignment: str = ""
    is_screened_out: bool = False

    def sign(self, campaign: Campaign) -> str:
        values = [self.browser, self.pseudonym, self.assignment, int(self.is_screened_out)]
        return signing.dumps(values, salt=f"{VISITOR}.{campaign.pk}")

    @classmethod
    def read(cls, campaign: Campaign, signed: str) -> Visitor | None:
        """Return whom the words were signed for; None if they were not, or too long ago."""
        try:
            values = signing.loads(signed, salt=f"{VISITOR}.{campaign.pk}", max_age=KNOWN_FOR)
            browser, pseudonym, assignment, is_screened_out = values
        except (signing.BadSignature, ValueError):
            return None
        return cls(browser, pseudonym, assignment, bool(is_screened_out))


@dataclass(frozen=True)
class Visit:
    """A request to a campaign: whose task it is about, None where they have not begun.

    ``is_preview``: nothing is stored, and nothing counts. ``is_carried``: by the address, not by a cookie.
    """

    request: HttpRequest
    campaign: Campaign
    visitor: Visitor
    contributor: Contributor | None
    is_carried: bool = False
    is_preview: bool = False

    def places(self) -> list[Submission]:
        """Return the places of the task in their order; none before it was begun."""
        if self.is_preview:
            return preview_places(self.campaign)
        if self.contributor is None:
            return []
        rows = self.contributor.submissions.select_related("prompt", "contributor__campaign")
        return list(rows.order_by("position"))

    def may_see(self, place: Submission) -> bool:
        """Return whether the text of a place is shown here: it is empty, or was written in this browser."""
        return not place.text or place.browser == self.visitor.browser

    def address(self, place: int | str = "", **query: str) -> str:
        """Return the address of a place of the task, of its end (``done``), or of the first page."""
        path = reverse("campaign", args=[self.campaign.key])
        if self.is_preview:
            query[VISIT] = PREVIEW
        elif self.is_carried:
            query[VISIT] = self.visitor.sign(self.campaign)
        return f"{path}{f'{place}/' if place else ''}{'?' if query else ''}{urlencode(query)}"

    def to(self, place: int | str = "", **query: str) -> HttpResponse:
        return self.finished(redirect(self.address(place, **query)))

    def page(self, template: str, status: int = 200, **context: object) -> HttpResponse:
        context |= {"campaign": self.campaign, "contributor": self.contributor, "visit": self}
        name = f"annotations/campaigns/{template}.html"
        return self.finished(render(self.request, name, context, status=status))

    def refusal(self, refusal: Refusal) -> HttpResponse:
        response = self.page("refusal", refusal.status, refusal=refusal.message)
        if refusal.wait:
            response["Retry-After"] = str(refusal.wait)
        return response

    def finished(self, response: HttpResponse) -> HttpResponse:
        """Return the response as the browser may show it: in the frames that the campaign allows, and known again."""
        if not (self.is_carried or self.is_preview):
            response.set_cookie(
                cookie_of(self.campaign),
                self.visitor.sign(self.campaign),
                max_age=KNOWN_FOR,
                path="/p/",
                httponly=True,
                samesite="Lax",
                secure=self.request.is_secure(),
            )
        origins = self.campaign.frame_origins.split()
        if not origins:
            return response
        response.xframe_options_exempt = True  # what Django's middleware reads
        # Made for views, these mark the answer of any function.
        allow: Any = csp_replace({"frame-ancestors": origins})
        goes_to = [origin_of(self.campaign.return_url)] if self.campaign.return_url else []
        allow_forms: Any = csp_update({"form-action": [*origins, *goes_to]})
        allowed: HttpResponse = allow(allow_forms(lambda: response))()
        return allowed


View = Callable[..., HttpResponse]


def cookie_of(campaign: Campaign) -> str:
    return f"campaign_{campaign.pk}"


def public_view(methods: tuple[str, ...]) -> Callable[[View], View]:
    """Return a view at ``/p/<key>/…`` for whoever has the link; it receives a ``Visit``.

    Whoever has a market's id goes on with the task of that id, also in another browser. What was written in
    another one is not shown: an id can be made up. The audit log records nothing: contributors are known by a
    pseudonym alone, also where they are logged in.
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

            def answer(request: HttpRequest) -> HttpResponse:
                try:
                    return view(visit, **kwargs)
                except Refusal as refusal:
                    return visit.refusal(refusal)

            if request.method != "POST" and (
                request.GET.keys() - OWN_PARAMETERS
                or (visit.is_carried and VISIT not in request.GET)
            ):
                # The market's ids leave the address, and with it every log of it.
                return visit.to(str(kwargs.get("position", "")))
            if visit.is_carried or visit.is_preview:
                return answer(request)
            return csrf_protect(answer)(request)

        reads = plain_view(methods, NOTHING)(guarded)
        return csrf_exempt(login_not_required(never_cache(reads)))

    return decorate


def visit_to(campaign: Campaign, request: HttpRequest) -> Visit:
    """Return whose visit a request is: the market's id in its address decides, then what the browser keeps."""
    sent = request.GET
    carried = Visitor.read(campaign, sent.get(VISIT, ""))
    known = carried or Visitor.read(campaign, request.COOKIES.get(cookie_of(campaign), ""))
    market, assignment = market_id_in(campaign, sent), assignment_in(campaign, sent)
    if sent.get(VISIT) == PREVIEW or assignment == NOT_ACCEPTED:
        nobody = Visitor("", PREVIEW)
        contributor = Contributor(campaign=campaign, pseudonym=PREVIEW)
        return Visit(request, campaign, nobody, contributor, is_preview=True)
    # Browsers that say nothing of frames get no cookie in one either.
    begins_in_frame = bool(campaign.frame_origins) and (
        request.headers.get("Sec-Fetch-Dest", FRAMES[0]) in FRAMES
    )
    is_carried = carried is not None or (known is None and begins_in_frame)
    visitor = known or Visitor(browser := new_device(), pseudonym_of(campaign, DEVICE, browser))
    if market is not None:
        pseudonym = pseudonym_of(campaign, *market)
        if pseudonym != visitor.pseudonym:
            visitor = Visitor(visitor.browser, pseudonym)
    if assignment:
        visitor = replace(visitor, assignment=assignment)
    known_as = contributor_of(campaign, visitor.pseudonym)
    return Visit(request, campaign, visitor, known_as, is_carried)
