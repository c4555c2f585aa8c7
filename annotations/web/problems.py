"""Problem documents (RFC 9457): what the API answers where it refuses, whoever refuses.

Nothing here needs a database, a template or the REST framework, so that the last handler of errors can use it.
"""

from __future__ import annotations

from http import HTTPStatus
from typing import Any

CONTENT_TYPE = "application/problem+json"
# The documents that each installation serves say what a code means. The workbench has no host of its own that could
# name them, so the reference begins with the path: it leads to the site that answered, and is the same on every site.
TYPES = "/docs/reference/problems/#doc-"


def problem(code: str, status: int, detail: str, title: str = "", **more: Any) -> dict[str, Any]:
    """Return a problem document. ``code`` names the reason for programs, ``detail`` says it to people."""
    return {
        "type": f"{TYPES}{code}",
        "title": title or HTTPStatus(status).phrase,
        "status": int(status),
        "code": code,
        "detail": detail,
        **more,
    }
