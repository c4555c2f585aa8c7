"""Which run is the learned part of what answers: what was decided and proposed, and the verbs that decide."""

from __future__ import annotations

from http import HTTPStatus

from django.db.models import QuerySet
from django.shortcuts import get_object_or_404
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.decorators import action
from rest_framework.mixins import ListModelMixin
from rest_framework.response import Response

from annotations.models import Duty
from annotations.web.rest.fields import Fields
from annotations.web.rest.idempotency import once
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import WorldViewSet
from parser_service.models import Promotion
from parser_service.runs.analysis_requests import request_measurement_with
from parser_service.runs.promoting import MOST_REASON, decline, promote, roll_back


class PromotionSerializer(serializers.ModelSerializer[Promotion]):
    """A run that was promoted, or proposed for it. ``evidence`` holds its scores and those of the run
    before it, as they were then; ``decided_by`` is null where a rule decided."""

    run = serializers.IntegerField(source="run_id")
    state = serializers.CharField()
    evidence = serializers.DictField()
    decided_by = serializers.CharField(source="decided_by.username", default=None)

    class Meta:
        model = Promotion
        fields = ["id", "run", "state", "reason", "evidence", "made_at", "decided_at", "decided_by"]


class NewPromotion(Fields):
    """The run that is to be the learned part of what answers."""

    run = serializers.IntegerField(min_value=1, max_value=2**63 - 1)
    reason = serializers.CharField(max_length=MOST_REASON, allow_blank=True, default="")


class RollBackReason(Fields):
    """Why the run before is to be the learned part again."""

    reason = serializers.CharField(max_length=MOST_REASON, allow_blank=True, default="")


class PromotionViewSet(ListModelMixin, WorldViewSet):
    """The promotions and proposals of a world, the last one first."""

    model = Promotion
    serializer_class = PromotionSerializer
    duties = dict.fromkeys(("create", "roll_back", "decline"), Duty.MANAGE)
    filter_backends = []
    sorts = {"newest": "-pk", "id": "pk"}

    def rows(self) -> QuerySet[Promotion]:
        return Promotion.objects.filter(world=self.world).select_related("decided_by")

    @extend_schema(request=NewPromotion, responses={201: PromotionSerializer})
    @once
    def create(self, request: ApiRequest, **kwargs: object) -> Response:
        """Makes a run the learned part of what answers: it is asked where the grammar oracle is silent."""
        sent = self.read(NewPromotion)
        run = get_object_or_404(self.world.runs.select_related("world"), pk=sent["run"])
        row = promote(run, request.user, sent["reason"])
        request_measurement_with(run, request.user)
        return Response(self.get_serializer(row).data, status=HTTPStatus.CREATED)

    @extend_schema(request=RollBackReason, responses={201: PromotionSerializer})
    @action(detail=False, methods=["post"], url_path="roll-back")
    @once
    def roll_back(self, request: ApiRequest, **kwargs: object) -> Response:
        """Makes the run before the present one the learned part again."""
        reason = self.read(RollBackReason)["reason"]
        row = roll_back(self.world, request.user, reason)
        return Response(self.get_serializer(row).data, status=HTTPStatus.CREATED)

    @extend_schema(request=None, responses={200: PromotionSerializer})
    @action(detail=True, methods=["post"])
    def decline(self, request: ApiRequest, **kwargs: object) -> Response:
        """Declines a proposal; the present run stays the learned part."""
        row = self.get_object()
        decline(self.world, row.pk, request.user)
        return Response(self.get_serializer(self.get_object()).data)
