"""What ends in a world, as server-sent events."""

from __future__ import annotations

import json

from django.http import HttpResponse
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiParameter, extend_schema

from annotations.background.endings import Ending, Mark, begin_mark, endings_after
from annotations.models import Job, World
from annotations.web.rest.negotiation import AnyType
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import WorldRoute

ASK_AGAIN = 5_000  # milliseconds
TYPE = "text/event-stream"
LAST = "Last-Event-ID"
_ADDRESSES = {"run": "runs", "job": "jobs", "campaign": "campaigns"}


class Events(WorldRoute):
    """Tells what has ended: runs, jobs such as imports, and campaigns."""

    model = Job
    content_negotiation_class = AnyType

    @extend_schema(
        operation_id="events",
        parameters=[
            OpenApiParameter(
                LAST,
                OpenApiTypes.STR,
                OpenApiParameter.HEADER,
                description="The id of the last event that the caller has. Without it the answer has no event, "
                "and an id from which on the next one tells.",
            )
        ],
        responses={(200, TYPE): OpenApiTypes.STR},
    )
    def get(self, request: ApiRequest, **kwargs: object) -> HttpResponse:
        """Answers at once, and closes: clients of server-sent events ask again with the last id by themselves."""
        pieces = [f"retry: {ASK_AGAIN}\n\n"]
        if last := request.headers.get(LAST):
            told = endings_after(self.world, Mark.read(last))
            pieces += [_event(self.world, ending, mark) for ending, mark in told]
        else:
            pieces.append(f"id: {begin_mark(self.world)}\n\n")
        return HttpResponse("".join(pieces), content_type=f"{TYPE}; charset=utf-8")


def _event(world: World, ending: Ending, mark: Mark) -> str:
    """Return an event with its data in one line of JSON."""
    data = {
        "id": ending.pk,
        "status": ending.status,
        "title": ending.title,
        "failure": ending.failure,
        "at": ending.at.isoformat(),
        "address": f"/api/v1/worlds/{world.name}/{_ADDRESSES[ending.kind]}/{ending.pk}/",
    }
    written = json.dumps(data, ensure_ascii=False)
    return f"event: {ending.kind}\nid: {mark}\ndata: {written}\n\n"
