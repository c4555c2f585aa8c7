"""Refusals that come before a view or instead of it, in plain words."""

from __future__ import annotations

import base64
import hashlib
from typing import Any

from csp.decorators import csp_update
from django.http import HttpRequest, HttpResponse, JsonResponse
from django.template import loader
from django.utils.html import format_html
from django.utils.safestring import mark_safe

from annotations.web.problems import CONTENT_TYPE, problem

# A page that needs nothing: no template, no file, no database.
STYLE = mark_safe(
    "body{max-width:36rem;margin:15vh auto;padding:0 1rem;font:1rem/1.5 system-ui,sans-serif}"
    "h1{font-size:1.5rem;line-height:1.25}"
)
STYLE_HASH = base64.b64encode(hashlib.sha256(STYLE.encode()).digest()).decode()
PAGE = """<!doctype html>
<html lang="en">
  <head>
    <meta charset="utf-8">
    <meta name="viewport" content="width=device-width, initial-scale=1">
    <meta name="color-scheme" content="light dark">
    <title>{title} · GPSR Workbench</title>
    <style>{style}</style>
  </head>
  <body>
    <main>
      <h1>{title}</h1>
      <p>{sentence}</p>
      <p><a href="/">Back to the start</a></p>
    </main>
  </body>
</html>
"""


def refuse(request: HttpRequest, status: int, title: str, sentence: str, code: str) -> HttpResponse:
    """Return a response that says what happened and what to do; problem+json with ``code`` below ``/api/``.

    Needs no database. From status 500 on the page needs no template and no static file either.
    """
    if request.path.startswith("/api/"):
        document = problem(code, status, sentence, title)
        return JsonResponse(document, status=status, content_type=CONTENT_TYPE)
    if status >= 500:
        page = format_html(PAGE, style=STYLE, title=title, sentence=sentence)
        # Made for views, it marks the answer of any function.
        allowing_the_style: Any = csp_update({"style-src": [f"'sha256-{STYLE_HASH}'"]})
        response: HttpResponse = allowing_the_style(lambda: HttpResponse(page, status=status))()
        return response
    page = loader.render_to_string("error.html", {"title": title, "sentence": sentence})
    return HttpResponse(page, status=status)
