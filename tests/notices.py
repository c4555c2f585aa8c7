"""What a page tells its reader, as tests ask for it: by level and not by sentence."""

from __future__ import annotations

from django.http import HttpResponse


def levels(answer: HttpResponse) -> list[str]:
    """Return the levels of the notices on a page, such as success, info or error, in their order."""
    return [each.level_tag for each in answer.context["messages"]]
