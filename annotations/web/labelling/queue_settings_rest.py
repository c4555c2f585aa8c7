"""The settings of the work queue: which share of items two people do."""

from __future__ import annotations

from typing import Any

from django.db import transaction
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.response import Response

from annotations.labelling.enqueuing import DOUBLE_KINDS, set_share, shares_of
from annotations.models import Duty, Scope, WorkKind, WorkShare
from annotations.web.rest.fields import Fields
from annotations.web.rest.matching import etag_of, require_match
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import WorldRoute


class SharesSerializer(serializers.Serializer[Any]):
    """The share of items of each kind that two people do independently of each other, in percent."""

    def get_fields(self) -> dict[str, Any]:
        shares = {
            str(kind): serializers.IntegerField(min_value=0, max_value=100) for kind in DOUBLE_KINDS
        }
        return {**super().get_fields(), **shares}


class SharesChange(SharesSerializer, Fields):
    """Shares that are to be others. Items that nobody has taken yet follow them."""


class QueueSettings(WorldRoute):
    """Shows and changes how many items of each kind two people do."""

    model = WorkShare
    serializer_class = SharesSerializer
    filter_backends = []
    pagination_class = None
    duties = {"GET": Duty.MANAGE, "PATCH": Duty.MANAGE}
    scopes = {"GET": Scope.READ}
    conditional = ("PATCH",)

    @extend_schema(operation_id="queue_settings", responses={200: SharesSerializer})
    def get(self, request: ApiRequest, **kwargs: object) -> Response:
        shown = shares_of(self.world)
        return Response(shown, headers={"ETag": etag_of(None, shown)})

    @extend_schema(
        operation_id="set_queue_settings", request=SharesChange, responses={200: SharesSerializer}
    )
    def patch(self, request: ApiRequest, **kwargs: object) -> Response:
        sent = self.read(SharesChange, partial=True)
        with transaction.atomic():
            self.hold_world()
            shown = shares_of(self.world)
            require_match(request, shown, shown)
            for kind, percent in sent.items():
                set_share(self.world, WorkKind(kind), percent)
        return self.get(request)
