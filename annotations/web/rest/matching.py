"""Which version of a row a request is about: ``ETag`` and ``If-Match`` (RFC 9110, section 13)."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Any

from django.core.serializers.json import DjangoJSONEncoder
from django.utils.http import parse_etags

from annotations.editing.edits import Overtaken
from annotations.language.texts import Refusal
from annotations.models import Campaign, Editable
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.problem_details import PreconditionRequired

ANY = "*"
OTHER = "This is not the version that you read."
WEAK = "If-Match takes no weak tag: send it as the ETag has it, without W/."


def etag_of(row: Any, shown: Mapping[str, Any]) -> str:
    """Return the tag of a row: its version number if it has one, else a hash of what is shown of it."""
    if isinstance(row, Editable | Campaign):
        return f'"{row.version}"'
    text = json.dumps(shown, sort_keys=True, cls=DjangoJSONEncoder)
    return f'"{hashlib.sha256(text.encode()).hexdigest()[:20]}"'


def require_match(request: ApiRequest, row: Any, shown: Mapping[str, Any]) -> None:
    """Refuse a write to a version of ``row`` that is not the present one; ``*`` stands for any.

    A weak tag names no version: it stands for rows that are nearly the same.
    Raises PreconditionRequired without a version, and Overtaken for another one.
    """
    asked = request.headers.get("If-Match")
    if not asked:
        raise PreconditionRequired
    tags = parse_etags(asked)
    if tags != [ANY] and etag_of(row, shown) not in tags:
        is_weak = any(tag.startswith("W/") for tag in tags)
        raise Changed(row, WEAK if is_weak else OTHER)


class Changed(Overtaken):
    """The row is at another version than the request says."""

    def __init__(self, row: Any, sentence: str = OTHER) -> None:
        self.sentence = sentence
        Refusal.__init__(self, f"{self.sentence} Compare yours with the present one below.")
        self.current = row
        self.base = self.last = None
