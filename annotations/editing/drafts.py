"""Keep on the server what somebody types, until they save it: for a reload, and for their other devices."""

from __future__ import annotations

from typing import Any

from django.db import models, transaction
from django.utils import timezone

from annotations.editing.once_keys import made_before
from annotations.language.errors import Refusal
from annotations.models import Draft, User, World
from annotations.models.editing import LONGEST_DEVICE, NEW

MOST_BYTES = 64 * 1024  # of a request that saves one
MOST_DRAFTS = 200  # of one person in one world; beyond it the oldest goes
MOST_FIELDS = 50


def read_draft(sent: Any) -> dict[str, Any]:
    """Return the values of a ``Draft`` in ``sent``, parsed JSON. Raises Refusal.

    ``sent`` has ``fields`` (name → text), ``version`` (a number or null) and ``device``.
    """
    fields = sent.get("fields") if isinstance(sent, dict) else None
    if not isinstance(fields, dict) or len(fields) > MOST_FIELDS:
        raise Refusal("Send the fields of the form by their names.", "draft_not_fields")
    for text in fields.values():
        if not isinstance(text, str):
            raise Refusal("Send the text of each field.", "draft_not_text")
    device, version = sent.get("device"), sent.get("version")
    if not isinstance(device, str) or len(device) > LONGEST_DEVICE:
        raise Refusal("Send a short name of the device.", "draft_device")
    if version is not None and not (type(version) is int and 0 <= version < 2**31):
        raise Refusal("Send the version that is edited as a number.", "draft_version")
    return {"fields": fields, "device": device, "base_version": version}


def save_draft(
    user: User, world: World, kind: str, subject: str, values: dict[str, Any]
) -> Draft | None:
    """Keep a draft in place of the last one about the same row; it is stored when this returns.

    ``values`` are those of ``read_draft``. Returns None for one that arrives after its form was sent.
    """
    if made_before(user, values["fields"].get("once", "")):
        return None
    key: dict[str, Any] = {"user": user, "world": world, "kind": kind, "subject": subject}
    with transaction.atomic():
        values = {**values, "saved_at": timezone.now()}
        draft, is_new = Draft.objects.update_or_create(**key, defaults=values)
        if is_new:
            mine = Draft.objects.filter(user=user, world=world).order_by("-saved_at")
            superfluous = mine.values_list("pk", flat=True)[MOST_DRAFTS : 2 * MOST_DRAFTS]
            Draft.objects.filter(pk__in=list(superfluous)).delete()
    return draft


def discard_draft(user: User, world: World, kind: str, subject: int | str) -> None:
    """Forget the draft, where there is one."""
    Draft.objects.filter(user=user, world=world, kind=kind, subject=str(subject)).delete()


def discard_draft_of_new(user: User, world: World, kind: str, once: str) -> None:
    """Forget the draft of a new row that was made by the form with the key ``once``."""
    is_of_form = models.Q(subject=NEW) | models.Q(subject__startswith=NEW, fields__once=once)
    Draft.objects.filter(is_of_form, user=user, world=world, kind=kind).delete()
