"""What the forms of all rooms stand on: the data that was sent, and what is said of a text that is refused."""

from __future__ import annotations

from django.http import HttpRequest, QueryDict

from annotations.language.errors import LanguageError


def posted(request: HttpRequest) -> QueryDict | None:
    """Return the data to bind a form to; None when nothing has been sent."""
    return request.POST if request.method == "POST" else None


def sentence_of(error: LanguageError) -> str:
    """Return what is wrong and what to do about it, without the place."""
    message = error.message[:1].upper() + error.message[1:]
    hint = f" {error.hint[:1].upper()}{error.hint[1:]}." if error.hint else ""
    return f"{message}.{hint}"
