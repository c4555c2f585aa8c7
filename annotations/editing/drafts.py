"""Keep on the server what somebody types, until they save it: for a reload, and for their other devices."""

from __future__ import annotations

from datetime import timedelta
from typing import Any

from django.db import models, transaction
from django.utils import timezone

from annotations.editing.once_keys import made_before
from annotations.language.texts import Refusal
from annotations.models import Draft, User, World
from annotations.models.editing import LONGEST_DEVICE, LONGEST_PAGE, NEW

MOST_BYTES = 64 * 1024  # of a request that saves one
MOST_DRAFTS = 200  # of one person in one world; beyond it the oldest goes
KEPT = timedelta(days=183)  # as in static/src/draft-storage.js
MOST_FIELDS = 50


def read_draft(sent: Any) -> dict[str, Any]:
    """Return the values of a ``Draft`` in ``sent``, parsed JSON. Raises Refusal.

    ``sent`` has ``fields`` (name → text), ``version`` (a number or null) and ``device``; and ``about`` and
    ``page``, for lists, where the browser says them.
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
    about, page = sent.get("about", ""), sent.get("page", "")
    if not isinstance(about, str) or not isinstance(page, str):
        raise Refusal("Send what lists call the draft, and its page, as text.", "draft_place")
    return {
        "fields": fields,
        "device": device,
        "base_version": version,
        "about": about,
        "page": page if len(page) <= LONGEST_PAGE else "",
    }


def save_draft(
    user: User, world: World, kind: str, subject: str, values: dict[str, Any]
) -> Draft | None:
    """Keep a draft in place of the last one about the same row; it is stored when this returns.

    It is as old as its last change: a page that only shows it again sends the same texts once more.
    ``values`` are those of ``read_draft``. Returns None for one that arrives after its form was sent.
    """
    if made_before(user, values["fields"].get("once", "")):
        return None
    key: dict[str, Any] = {"user": user, "world": world, "kind": kind, "subject": subject}
    now = timezone.now()
    with transaction.atomic():
        before = Draft.objects.filter(**key).first()
        is_same = before is not None and _texts(before.fields) == _texts(values["fields"])
        saved_at = before.saved_at if before is not None and is_same else now
        values = {**values, "saved_at": saved_at}
        draft, is_new = Draft.objects.update_or_create(**key, defaults=values)
        if is_new:
            Draft.objects.filter(user=user, saved_at__lt=now - KEPT).delete()
            mine = Draft.objects.filter(user=user, world=world).order_by("-saved_at")
            superfluous = mine.values_list("pk", flat=True)[MOST_DRAFTS : 2 * MOST_DRAFTS]
            Draft.objects.filter(pk__in=list(superfluous)).delete()
    return draft


def _texts(fields: dict[str, str]) -> dict[str, str]:
    """Leave out the key of a new form, which is another one each time."""
    return {name: text for name, text in fields.items() if name != "once"}


def drafts_of(user: User) -> models.QuerySet[Draft]:
    """Return what ``user`` has typed and not saved in the worlds that they see, the newest first."""
    worlds = World.objects.visible_to(user)
    rows = Draft.objects.filter(user=user, world__in=worlds, saved_at__gte=timezone.now() - KEPT)
    return rows.select_related("world").order_by("-saved_at", "-pk")


def discard_draft(user: User, world: World, kind: str, subject: int | str) -> None:
    """Forget the draft, where there is one."""
    Draft.objects.filter(user=user, world=world, kind=kind, subject=str(subject)).delete()


def discard_draft_of_new(user: User, world: World, kind: str, once: str) -> None:
    """Forget the draft of a new row that was made by the form with the key ``once``."""
    is_of_form = models.Q(subject=NEW) | models.Q(subject__startswith=NEW, fields__once=once)
    Draft.objects.filter(is_of_form, user=user, world=world, kind=kind).delete()
