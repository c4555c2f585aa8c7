"""``Idempotency-Key``: the same request, sent again with the same key, is answered as it was."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from functools import wraps
from http import HTTPStatus
from typing import Any

from django.core.cache import cache
from django.core.serializers.json import DjangoJSONEncoder
from rest_framework.exceptions import ValidationError
from rest_framework.response import Response

from annotations.editing.once_keys import REMEMBERED_SECONDS
from annotations.language.texts import Refusal
from annotations.web.rest.permissions import ApiRequest

HEADER = "Idempotency-Key"
LONGEST = 255
WORKING_SECONDS = 600  # after which a request that never ended is forgotten
KEPT_HEADERS = ("ETag", "Location")
Method = Callable[..., Response]


def once(method: Method) -> Method:
    """Wrap a method of a route: it carries out a request with the same key only once a day."""

    @wraps(method)
    def answer(view: Any, request: ApiRequest, **kwargs: Any) -> Response:
        slot = slot_of(request)
        if not slot:
            return method(view, request, **kwargs)
        sent = fingerprint_of(request)
        if not cache.add(slot, {"sent": sent}, WORKING_SECONDS):
            return _replay(cache.get(slot), sent)
        try:
            response = method(view, request, **kwargs)
        except BaseException:
            cache.delete(slot)  # nothing was done, so the key can be used again
            raise
        kept = {
            "sent": sent,
            "status": response.status_code,
            "data": json.dumps(response.data, cls=DjangoJSONEncoder),
            "headers": {name: response[name] for name in KEPT_HEADERS if name in response},
        }
        cache.set(slot, kept, REMEMBERED_SECONDS)
        return response

    answer.takes_key = True  # type: ignore[attr-defined]  # of a function
    return answer


def slot_of(request: ApiRequest) -> str:
    """Return the cache key for the answer to this request; empty without an idempotency key. Raises ValidationError."""
    key = request.headers.get(HEADER, "")
    if len(key) > LONGEST:
        raise ValidationError({HEADER: [f"A key has {LONGEST} characters at most."]})
    where = f"{request.user.pk}:{request.method}:{request.path}:{key}"
    return f"api:{hashlib.sha256(where.encode()).hexdigest()}" if key else ""


def fingerprint_of(request: ApiRequest) -> str:
    """Return a hash of what was sent, files with their contents."""
    digest = hashlib.sha256(request.META.get("QUERY_STRING", "").encode())
    files = [(name, file) for name, some in request.FILES.lists() for file in some]
    data: Any = request.data
    if hasattr(data, "lists"):
        data = dict(data.lists())
    elif not isinstance(data, dict):
        data = {"": data}
    values = {name: value for name, value in data.items() if name not in request.FILES}
    digest.update(json.dumps(values, sort_keys=True, default=str).encode())
    for name, file in sorted(files, key=lambda each: (each[0], each[1].name)):
        digest.update(f"\0{name}\0{file.name}\0".encode(errors="replace"))
        for chunk in file.chunks():
            digest.update(chunk)
        file.seek(0)
    return digest.hexdigest()


def _replay(kept: dict[str, Any] | None, sent: str) -> Response:
    if kept is None or ("status" not in kept and kept["sent"] == sent):
        said = "The first request with this key is still being worked on. Ask again later."
        raise Refusal(said, "still_worked_on", HTTPStatus.CONFLICT)
    if kept["sent"] != sent:
        raise Refusal(
            f"This {HEADER} was sent with another request. Choose a new one.",
            "key_of_another_request",
            HTTPStatus.UNPROCESSABLE_ENTITY,
        )
    response = Response(json.loads(kept["data"]), status=kept["status"], headers=kept["headers"])
    response["Idempotency-Replayed"] = "true"
    return response
