"""Middleware: normalise the texts of forms and queries before a view sees them, and tell people."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from django.contrib import messages
from django.db import DataError
from django.http import HttpRequest, HttpResponse

from annotations.language.texts import TextChanges
from annotations.web.sent_texts import sent_texts_of
from gpsr_site.web.refusals import refuse

FORM_TYPES = ("application/x-www-form-urlencoded", "multipart/form-data")
API = "/api/"
HEADER = "Text-Changes"
LONGEST_HEADER = 4_000  # characters; clients refuse long ones


class NormaliseTexts:
    """Middleware, behind that of messages: whatever somebody types, it is stored in one normal form.

    What was changed is said on the page after the form, and to programs in the header
    ``Text-Changes``. The API's parsers read the bodies that are sent to it.
    """

    def __init__(self, get_response: Callable[[HttpRequest], HttpResponse]) -> None:
        self.get_response = get_response

    def __call__(self, request: HttpRequest) -> HttpResponse:
        response = self.get_response(request)
        sent = sent_texts_of(request)
        if sent.changes and request.path.startswith(API):
            # Names of fields may have any characters, and line breaks too.
            response[HEADER] = "".join(
                sign if " " <= sign <= "~" else "?" for sign in str(sent)[:LONGEST_HEADER]
            )
        elif sent.changes and request.method == "POST" and 300 <= response.status_code < 400:
            total = sum(sent.changes.values(), start=TextChanges())
            messages.info(request, f"In what you wrote, {total}.")
        return response

    def process_exception(self, request: HttpRequest, error: Exception) -> HttpResponse | None:
        """Answer 400 where a number or text is beyond what the database can compare or hold."""
        if not isinstance(error, OverflowError | DataError):
            return None
        sentence = "A number or a text here is larger than can be stored. Write a smaller one."
        return refuse(request, 400, "This is too large", sentence, "too_large")

    def process_view(self, request: HttpRequest, view: Any, args: Any, kwargs: Any) -> None:
        if request.META.get("QUERY_STRING"):
            request.GET = sent_texts_of(request).read_form(request.GET)  # type: ignore[assignment]  # one class at run time
        is_form = request.content_type in FORM_TYPES and not request.path.startswith(API)
        if is_form and request.method == "POST":
            request.POST = sent_texts_of(request).read_form(request.POST)  # type: ignore[assignment]  # the same
