"""Parsing over the API: the parse server answers, this route says who may ask."""

from __future__ import annotations

from typing import Any

from django.http import HttpResponseBase, StreamingHttpResponse
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiParameter, OpenApiResponse, extend_schema
from rest_framework import serializers
from rest_framework.exceptions import APIException
from rest_framework.negotiation import DefaultContentNegotiation
from rest_framework.parsers import BaseParser
from rest_framework.renderers import BaseRenderer
from rest_framework.request import Request
from rest_framework.response import Response
from rest_framework.views import APIView

from annotations.api.parsing import BoundedJSONParser
from annotations.api.permissions import HasDuty
from annotations.api.reading import Fields
from annotations.models import Duty, Scope, World
from annotations.models.corpus import MOST_CHARACTERS
from parser_service.serving.client import ParserAway, ParserRefused, client
from parser_service.serving.preparing import MOST_CANDIDATES

JSON_LINES = "application/jsonl"
MOST_KEY = 2**63 - 1


class Away(APIException):
    """The parse server does not answer."""

    status_code = 503
    default_code = "parser_away"
    wait = 2  # seconds until it is worth asking again (Retry-After)


class Refused(APIException):
    """What the parse server says about a request that it cannot answer."""

    def __init__(self, error: ParserRefused) -> None:
        super().__init__(str(error), code="not_parsed")
        self.status_code = error.status


class JsonLinesToo(DefaultContentNegotiation):
    """Takes any header ``Accept``: what was sent decides whether JSON or JSON lines are answered."""

    def select_renderer(
        self, request: Request, renderers: list[BaseRenderer], format_suffix: str | None = None
    ) -> tuple[BaseRenderer, str]:
        return renderers[0], renderers[0].media_type


class JsonLinesParser(BaseParser):
    """Takes JSON lines as they are; the parse server reads them."""

    media_type = JSON_LINES

    def parse(self, stream: Any, media_type: Any = None, parser_context: Any = None) -> bytes:
        return bytes(stream.read())


class ParseQuery(Fields):
    """What to parse, in at most ``beam`` ways; ``run`` asks another parser than the promoted one."""

    utterance = serializers.CharField(max_length=MOST_CHARACTERS, trim_whitespace=False)
    beam = serializers.IntegerField(default=5, min_value=1, max_value=MOST_CANDIDATES)
    run = serializers.IntegerField(default=None, min_value=1, max_value=MOST_KEY, allow_null=True)


class BatchQuery(serializers.Serializer):
    """The same for JSON lines, in the address."""

    beam = serializers.IntegerField(default=5, min_value=1, max_value=MOST_CANDIDATES)
    run = serializers.IntegerField(default=None, min_value=1, max_value=MOST_KEY, allow_null=True)


class SpanSerializer(serializers.Serializer):
    """The characters ``start`` to ``end`` of the utterance name an entity."""

    start = serializers.IntegerField()
    end = serializers.IntegerField()
    text = serializers.CharField()
    token = serializers.CharField()
    entity_class = serializers.CharField()
    value = serializers.CharField()


class OpenSlotSerializer(serializers.Serializer):
    """A slot to ask about. ``choices`` are those that the utterance names (``is_named``), the likely one
    first, or else entities of the class; ``phrases`` are unknown words that may be meant."""

    path = serializers.ListField(child=serializers.IntegerField())
    token = serializers.CharField()
    entity_class = serializers.CharField()
    question = serializers.CharField()
    is_named = serializers.BooleanField()
    likely = serializers.CharField(allow_null=True)
    choices = serializers.ListField(child=serializers.CharField())
    phrases = serializers.ListField(child=serializers.CharField())


class CandidateSerializer(serializers.Serializer):
    """A form, with class tokens and with the entities of the utterance (``grounded``)."""

    form = serializers.CharField()
    grounded = serializers.CharField()
    score = serializers.FloatField()
    is_well_formed = serializers.BooleanField()
    reading = serializers.CharField()
    english = serializers.CharField()
    open_slots = OpenSlotSerializer(many=True)
    remarks = serializers.ListField(child=serializers.CharField())
    plan = serializers.DictField(allow_null=True, help_text="As docs/plans.md describes it.")


class ParseSerializer(serializers.Serializer):
    """The answer to an utterance; candidates are ranked, the best first."""

    world = serializers.CharField()
    run = serializers.IntegerField()
    parser = serializers.CharField()
    score_kind = serializers.CharField()
    utterance = serializers.CharField()
    anonymized = serializers.CharField()
    spans = SpanSerializer(many=True)
    parsed_text = serializers.CharField()
    is_unknown = serializers.BooleanField()
    is_cut = serializers.BooleanField(help_text="The parser read only the beginning.")
    remarks = serializers.ListField(child=serializers.CharField())
    candidates = CandidateSerializer(many=True)


class ParseRoute(APIView):
    """Parses an utterance, or JSON lines with one each, with the promoted parser of the world."""

    permission_classes = [HasDuty]
    parser_classes = [BoundedJSONParser, JsonLinesParser]
    content_negotiation_class = JsonLinesToo
    duty = Duty.VIEW
    scopes = {"POST": Scope.READ}  # it stores nothing
    world: World

    @extend_schema(
        operation_id="parse",
        parameters=[
            OpenApiParameter(
                "beam", OpenApiTypes.INT, description="Of JSON lines: candidates each."
            ),
            OpenApiParameter("run", OpenApiTypes.INT, description="Of JSON lines: the run to ask."),
        ],
        request={"application/json": ParseQuery, JSON_LINES: OpenApiTypes.STR},
        responses={
            (200, "application/json"): ParseSerializer,
            (200, JSON_LINES): OpenApiTypes.STR,
            503: OpenApiResponse(description="The parse server is away, or still loading."),
        },
    )
    def post(self, request: Request, world: str) -> HttpResponseBase:
        try:
            if isinstance(request.data, bytes):
                return self._answer_lines(request, request.data)
            query = ParseQuery(data=request.data)
            query.is_valid(raise_exception=True)
            return Response(client().parse(self.world.name, **query.validated_data))
        except ParserAway as error:
            raise Away(str(error)) from error
        except ParserRefused as error:
            raise Refused(error) from error

    def _answer_lines(self, request: Request, lines: bytes) -> HttpResponseBase:
        query = BatchQuery(data=request.query_params)
        query.is_valid(raise_exception=True)
        answers = client().parse_lines(self.world.name, lines, **query.validated_data)
        return StreamingHttpResponse(answers, content_type=f"{JSON_LINES}; charset=utf-8")
