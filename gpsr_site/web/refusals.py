"""Refusals that come before a view or instead of it, in plain words."""

from __future__ import annotations

from django.http import HttpRequest, HttpResponse, JsonResponse
from django.template import loader


def refuse(request: HttpRequest, status: int, title: str, sentence: str) -> HttpResponse:
    """Return a response that says what happened and what to do; problem+json below ``/api/``.

    Needs no database: it is also what people see while that is away.
    """
    if request.path.startswith("/api/"):
        problem = {"type": "about:blank", "title": title, "status": status, "detail": sentence}
        return JsonResponse(problem, status=status, content_type="application/problem+json")
    page = loader.render_to_string("error.html", {"title": title, "sentence": sentence})
    return HttpResponse(page, status=status)
