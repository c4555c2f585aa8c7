"""What answers in a world: which parts, in which order, and how sure an answer has to be to be acted on."""

from __future__ import annotations

from typing import Any

from django.db import transaction
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.response import Response

from annotations.models import Duty
from annotations.web.rest.fields import Fields
from annotations.web.rest.matching import etag_of, require_match
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import WorldRoute
from parser_service.models import Answering, AnsweringOrder
from parser_service.models.answering import MOST_ALLOWED_WRONG, answering_of
from parser_service.parsers.registry import ORACLE
from parser_service.serving.answering import (
    answering_parts,
    calibrated_parts,
    choose_answering,
    version_of,
)

_CHOSEN = ("order", "allowed_wrong", "asks_language_model")


class AnsweringPartSerializer(serializers.Serializer[Any]):
    """A part that is asked: its parser, and the run that it is of; the grammar oracle needs none."""

    parser = serializers.CharField()
    run = serializers.IntegerField(allow_null=True)


class OperatingPointSerializer(serializers.Serializer[Any]):
    """The least probability with which an answer is acted on, and with which it is confirmed."""

    act = serializers.FloatField()
    confirm = serializers.FloatField()


class AnswererSerializer(serializers.Serializer[Any]):
    """``allowed_wrong`` is the share of wrong ones that is allowed among what is acted on, ``version`` 0 until somebody
    chooses. ``asks_language_model``: whether what no other part understands is sent to the configured language model.
    ``parts`` are asked in this order. ``calibrated_on`` is how many utterances of people said what the evidence for an
    answer is worth."""

    order = serializers.ChoiceField(choices=AnsweringOrder.choices)
    allowed_wrong = serializers.FloatField()
    asks_language_model = serializers.BooleanField()
    version = serializers.IntegerField()
    parts = AnsweringPartSerializer(many=True)
    calibrated_on = serializers.IntegerField()
    operating_point = OperatingPointSerializer()


class AnswererChange(Fields):
    """What is to be otherwise."""

    allowed_wrong = serializers.FloatField(min_value=0, max_value=MOST_ALLOWED_WRONG)
    asks_language_model = serializers.BooleanField()

    def get_fields(self) -> dict[str, Any]:
        order = serializers.ChoiceField(choices=AnsweringOrder.choices)
        return {**super().get_fields(), "order": order}


class OneAnswerer(WorldRoute):
    """Shows what answers in a world, and lets admins choose it."""

    model = Answering
    serializer_class = AnswererSerializer
    filter_backends = []
    pagination_class = None
    duties = {"PATCH": Duty.MANAGE}
    conditional = ("PATCH",)

    @extend_schema(operation_id="answerer", responses={200: AnswererSerializer})
    def get(self, request: ApiRequest, **kwargs: object) -> Response:
        shown = self._shown()
        return Response(shown, headers={"ETag": etag_of(None, shown)})

    @extend_schema(
        operation_id="choose_answerer",
        request=AnswererChange,
        responses={200: AnswererSerializer},
    )
    def patch(self, request: ApiRequest, **kwargs: object) -> Response:
        sent = self.read(AnswererChange, partial=True)
        with transaction.atomic():
            self.hold_world()
            shown = self._shown()
            require_match(request, shown, shown)
            chosen = {name: shown[name] for name in _CHOSEN} | sent
            choose_answering(self.world, **chosen, by=request.user, version=shown["version"])
        return self.get(request)

    def _shown(self) -> dict[str, Any]:
        row, parts = answering_of(self.world), answering_parts(self.world)
        oracle = [{"parser": ORACLE, "run": None}] if parts.has_oracle else []
        learned = [{"parser": each.parser, "run": each.pk} for each in parts.runs]
        found = calibrated_parts(self.world, row, parts)
        return {
            **{name: getattr(row, name) for name in _CHOSEN},
            "version": version_of(row),
            "parts": oracle + learned,
            "calibrated_on": found.calibration.examples,
            "operating_point": {"act": found.point.act, "confirm": found.point.confirm},
        }
