"""Utterances over the API: what their list shows, and more of them taken in."""

from __future__ import annotations

from django.shortcuts import get_object_or_404
from drf_spectacular.utils import OpenApiResponse, extend_schema
from rest_framework import serializers, status
from rest_framework.exceptions import ValidationError
from rest_framework.pagination import CursorPagination
from rest_framework.request import Request
from rest_framework.response import Response
from rest_framework.views import APIView

from annotations.api.permissions import HasDuty
from annotations.labelling import collect
from annotations.labelling.collecting import MOST_AT_ONCE
from annotations.models import Duty, Origin, Utterance, World
from annotations.models.utterances import origin_choices, utterance_status_choices

REFUSALS = {
    401: OpenApiResponse(description="No token, or one that is not valid."),
    404: OpenApiResponse(description="No such utterance in a world that you can see."),
}


class UtteranceSerializer(serializers.ModelSerializer):
    """An utterance with its form, which is empty while nobody has given it one."""

    created_by = serializers.CharField(source="created_by.username", default=None)

    class Meta:
        model = Utterance
        fields = [
            *("id", "text", "anonymized_text", "spans", "origin", "status", "logical_form"),
            *("version", "created_by", "created_at"),
        ]


class UtteranceQuery(serializers.Serializer):
    """Which utterances to list; all of them where nothing is asked."""

    status = serializers.ChoiceField(choices=utterance_status_choices(), required=False)
    origin = serializers.ChoiceField(choices=origin_choices(), required=False)


class NewUtterances(serializers.Serializer):
    """Texts that people said. With an error in one of them nothing is stored."""

    texts = serializers.ListField(
        child=serializers.CharField(trim_whitespace=False, allow_blank=True, max_length=5_000),
        max_length=MOST_AT_ONCE,
    )
    origin = serializers.ChoiceField(choices=origin_choices(), default=Origin.UPLOADED)


class CollectedSerializer(serializers.Serializer):
    added = serializers.IntegerField()
    duplicates = serializers.ListField(child=serializers.CharField())


class Pages(CursorPagination):
    page_size = 500
    ordering = "id"


class Utterances(APIView):
    """Lists utterances, the oldest first, and takes new ones in."""

    permission_classes = [HasDuty]
    world: World

    @property
    def duty(self) -> Duty:
        """What the method needs."""
        return Duty.ANNOTATE if self.request.method == "POST" else Duty.VIEW

    @extend_schema(
        operation_id="utterances",
        parameters=[UtteranceQuery],
        responses={200: UtteranceSerializer(many=True), **REFUSALS},
    )
    def get(self, request: Request, world: str) -> Response:
        query = UtteranceQuery(data=request.query_params)
        query.is_valid(raise_exception=True)
        rows = self.world.utterances.select_related("created_by").filter(**query.validated_data)
        pages = Pages()
        page = pages.paginate_queryset(rows, request, view=self)
        return pages.get_paginated_response(UtteranceSerializer(page, many=True).data)

    @extend_schema(
        operation_id="collect_utterances",
        request=NewUtterances,
        responses={
            201: CollectedSerializer,
            400: OpenApiResponse(description="A text cannot be stored."),
            **REFUSALS,
        },
    )
    def post(self, request: Request, world: str) -> Response:
        sent = NewUtterances(data=request.data)
        sent.is_valid(raise_exception=True)
        texts, origin = sent.validated_data["texts"], sent.validated_data["origin"]
        collected = collect(self.world, texts, origin, request.user)
        if collected.problems:
            raise ValidationError({"texts": [str(problem) for problem in collected.problems]})
        values = {"added": collected.added, "duplicates": list(collected.duplicates)}
        return Response(values, status=status.HTTP_201_CREATED)


class OneUtterance(APIView):
    """Shows one utterance."""

    permission_classes = [HasDuty]
    duty = Duty.VIEW
    world: World

    @extend_schema(operation_id="utterance", responses={200: UtteranceSerializer, **REFUSALS})
    def get(self, request: Request, world: str, pk: int) -> Response:
        row = get_object_or_404(self.world.utterances.select_related("created_by"), pk=pk)
        return Response(UtteranceSerializer(row).data)
