"""What somebody types, kept while they type: asked for and sent by ``static/src/drafts.js``; and the list of it."""

from __future__ import annotations

import json

from django.http import Http404, HttpResponse, JsonResponse
from django.shortcuts import render
from django.urls import reverse
from django.views.decorators.cache import never_cache

from annotations.editing.drafts import (
    MOST_BYTES,
    discard_draft,
    drafts_of,
    read_draft,
    save_draft,
)
from annotations.language.texts import Refusal
from annotations.models import Draft, Duty, World
from annotations.models.editing import NEW
from annotations.people.access import (
    NOTHING,
    READ_AND_WRITE,
    PageRequest,
    WorldRequest,
    plain_view,
    world_view,
)
from annotations.showing.paging import number_in
from annotations.web.editing.kinds_of_rows import kind_named
from annotations.web.sent_texts import sent_texts_of

LONGEST_SUBJECT = Draft._meta.get_field("subject").max_length


@never_cache
@plain_view()
def my_drafts(request: PageRequest) -> HttpResponse:
    """List what the reader has typed and not saved. Their browser adds what it alone keeps (``my-drafts.js``)."""
    drafts = [(each, _page_of(each)) for each in drafts_of(request.user)]
    worlds = {
        world.pk: {"name": world.name, "url": _start_of(world)}
        for world in World.objects.visible_to(request.user)
    }
    context = {"drafts": drafts, "worlds_of_drafts": worlds}
    return render(request, "annotations/editing/my_drafts.html", context)


def _start_of(world: World) -> str:
    return reverse("world", kwargs={"world": world.name})


def _page_of(row: Draft) -> str:
    """Return the address of the form, under the name that its world has now; empty where it is not known."""
    return f"{_start_of(row.world)}{row.page}" if row.page else ""


@never_cache
@world_view(Duty.ANNOTATE, READ_AND_WRITE, does=NOTHING)
def draft(request: WorldRequest, world: World, kind: str, subject: str) -> JsonResponse:
    """Return the reader's own draft about a row. A POST keeps or discards it.

    A POST brings JSON: ``of`` (the account that the page was made for), then either
    ``{"discard": true}`` or ``fields``, ``version`` and ``device``.
    """
    of_kind = kind_named(kind)
    if len(subject) > (LONGEST_SUBJECT or 0):
        raise Http404("There is no such draft.")
    about = subject.partition("-")[0]
    if about != NEW:
        of_kind.row_or_last_known(world, number_in(about))
    if request.method == "POST":
        return _post(request, world, kind, subject)
    key = {"user": request.user, "world": world, "kind": kind, "subject": subject}
    stored = Draft.objects.filter(**key).first()
    shown = stored and {
        "fields": stored.fields,
        "version": stored.base_version,
        "device": stored.device,
        "about": stored.about,
        "page": stored.page,
        "saved_at": stored.saved_at.isoformat(),
    }
    return JsonResponse({"draft": shown})


def _post(request: WorldRequest, world: World, kind: str, subject: str) -> JsonResponse:
    if request.content_type != "application/json":  # the body of a form has been read already
        return JsonResponse({"error": "Send a draft as application/json."}, status=400)
    if len(request.body) > MOST_BYTES:
        sentence = (
            f"A draft has at most {MOST_BYTES // 1024} kB. This text is in your browser only."
        )
        return JsonResponse({"error": sentence}, status=413)
    try:
        sent = sent_texts_of(request).read_json(json.loads(request.body))
        is_discarded = isinstance(sent, dict) and sent.get("discard") is True
        values = {} if is_discarded else read_draft(sent)
    except Refusal as refusal:
        return JsonResponse({"error": refusal.message}, status=400)
    except (ValueError, RecursionError):
        return JsonResponse({"error": "This is not JSON."}, status=400)
    if sent.get("of") != request.user.pk:
        sentence = "You have logged in as somebody else since. The draft is in your browser only."
        return JsonResponse({"error": sentence}, status=409)
    if not values:
        discard_draft(request.user, world, kind, subject)
        return JsonResponse({"draft": None})
    saved = save_draft(request.user, world, kind, subject, values)
    return JsonResponse({"saved_at": saved and saved.saved_at.isoformat()})
