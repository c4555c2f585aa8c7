"""Parsing over the API: the parse server answers, this route says who may ask."""

from __future__ import annotations

import json
from collections.abc import Iterator
from http import HTTPStatus
from typing import Any

from django.http import HttpResponseBase, StreamingHttpResponse
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiParameter, OpenApiResponse, extend_schema
from rest_framework import serializers
from rest_framework.exceptions import ValidationError
from rest_framework.negotiation import DefaultContentNegotiation
from rest_framework.parsers import BaseParser
from rest_framework.response import Response
from rest_framework.views import APIView

from annotations.language.texts import Refusal
from annotations.models import Duty, Job, Scope, World
from annotations.models.corpus import MOST_CHARACTERS
from annotations.web.rest.fields import Fields
from annotations.web.rest.idempotency import once
from annotations.web.rest.negotiation import AnyType
from annotations.web.rest.parsing import BoundedJSONParser
from annotations.web.rest.permissions import ApiRequest, HasDuty
from annotations.web.rest.routes import WorldRoute
from annotations.web.rest.streaming import JSON_LINES, JSON_LINES_TYPES, BrokenOff
from annotations.web.worlds.job_rest import JobSerializer, accepted
from parser_service.parsers.registry import untrained
from parser_service.serving.batch_requests import request_batch
from parser_service.serving.parser_client import AWAY, ParserAway, client
from parser_service.serving.preparing import MOST_ALTERNATIVES, MOST_CANDIDATES, numbered_lines
from parser_service.web.serving.plan_fields import JointPlanField, PlanField

MOST_LINES = 5_000  # of a batch that is answered at once
MOST_SECONDS = 50  # then a last line says that the batch breaks off
MOST_KEY = 2**63 - 1


class JsonLinesToo(DefaultContentNegotiation):
    """Takes any header ``Accept``: what was sent decides whether JSON or JSON lines are answered."""

    select_renderer = AnyType.select_renderer


class JsonLinesParser(BaseParser):
    """Takes JSON lines as they are; the parse server reads them."""

    media_type = JSON_LINES

    def parse(self, stream: Any, media_type: Any = None, parser_context: Any = None) -> Any:
        return bytes(stream.read())


JSON_LINES_PARSERS = [
    type("JsonLinesParser", (JsonLinesParser,), {"media_type": each}) for each in JSON_LINES_TYPES
]


class AskedParser(serializers.Serializer[Any]):
    """In how many ways to parse, and whom to ask: what answers in the world, or one parser alone."""

    beam = serializers.IntegerField(
        default=5, min_value=1, max_value=MOST_CANDIDATES, help_text="The most candidates."
    )
    run = serializers.IntegerField(
        default=None,
        min_value=1,
        max_value=MOST_KEY,
        allow_null=True,
        help_text="Ask the parser of this run alone.",
    )
    parser = serializers.ChoiceField(
        choices=untrained(),
        default="",
        allow_blank=True,
        help_text="Ask this parser alone. It needs no run. Empty for what answers in the world.",
    )

    def validate(self, attrs: dict[str, Any]) -> dict[str, Any]:
        if attrs["run"] and attrs["parser"]:
            raise ValidationError("Name a run or a parser, not both.")
        return attrs


class AlternativeSerializer(Fields):
    """What a recogniser may have heard, with its score: a probability, or the logarithm of one."""

    utterance = serializers.CharField(max_length=MOST_CHARACTERS, trim_whitespace=False)
    score = serializers.FloatField(default=0.0)


class ParseQuery(AskedParser, Fields):
    """An utterance, or the ``alternatives`` of a recogniser. The best one that is understood is answered."""

    utterance = serializers.CharField(
        max_length=MOST_CHARACTERS, trim_whitespace=False, default="", allow_blank=True
    )
    alternatives = serializers.ListField(
        child=AlternativeSerializer(), default=list, max_length=MOST_ALTERNATIVES
    )

    def validate(self, attrs: dict[str, Any]) -> dict[str, Any]:
        if bool(attrs["utterance"].strip()) == bool(attrs["alternatives"]):
            raise ValidationError({"utterance": "Send an utterance or alternatives."})
        return super().validate(attrs)


class SpanSerializer(serializers.Serializer[Any]):
    """The characters ``start`` to ``end`` of the utterance name an entity: as it is called (``likeness``
    exact), by an alias, or inflected; or name its class, for one of its members."""

    start = serializers.IntegerField()
    end = serializers.IntegerField()
    text = serializers.CharField()
    token = serializers.CharField()
    entity_class = serializers.CharField()
    value = serializers.CharField()
    likeness = serializers.ChoiceField(choices=["exact", "alias", "inflected", "member"])


class OpenSlotSerializer(serializers.Serializer[Any]):
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


class HeardChangeSerializer(serializers.Serializer[Any]):
    """What was heard otherwise than it was said, in the characters ``start`` to ``end`` of the utterance."""

    kind = serializers.CharField(help_text="Such as filler, repair, sound or spelling.")
    start = serializers.IntegerField()
    end = serializers.IntegerField()
    said = serializers.CharField(allow_blank=True, help_text="Empty where something was left out.")
    heard = serializers.CharField(allow_blank=True, help_text="Empty where it was passed over.")


class ReasonSerializer(serializers.Serializer[Any]):
    """Why the robot does not act at once."""

    code = serializers.CharField(help_text="For programs: unknown_word, forbidden, left_out, …")
    message = serializers.CharField()


class CandidateSerializer(serializers.Serializer[Any]):
    """A form, with class tokens and with the entities of the utterance (``grounded``)."""

    form = serializers.CharField()
    grounded = serializers.CharField()
    score = serializers.FloatField()
    is_well_formed = serializers.BooleanField()
    reading = serializers.CharField()
    english = serializers.CharField()
    open_slots = OpenSlotSerializer(many=True)
    warnings = serializers.ListField(child=serializers.CharField())
    plan = PlanField(allow_null=True, help_text="As docs/reference/plans.md describes it.")
    task_plan = PlanField(allow_null=True, help_text="As docs/reference/recipes.md describes it.")
    spoken = serializers.CharField(
        allow_blank=True,
        help_text="Of the first candidate what the answer says; of others what the robot would do.",
    )
    values = serializers.ListField(
        child=serializers.CharField(allow_null=True),
        help_text="The entities of the class tokens in order, where the parser says which words it took.",
    )


class OneAnswerSerializer(serializers.Serializer[Any]):
    """The answer to one command; candidates are ranked, the best first."""

    world = serializers.CharField()
    run = serializers.IntegerField(
        allow_null=True, help_text="The run that answered; null where the grammar oracle did."
    )
    parser = serializers.CharField(help_text="The part that answered.")
    score_kind = serializers.CharField()
    utterance = serializers.CharField()
    anonymized = serializers.CharField()
    spans = SpanSerializer(many=True)
    parsed_text = serializers.CharField()
    is_unknown = serializers.BooleanField()
    is_cut = serializers.BooleanField(help_text="The parser read only the beginning.")
    warnings = serializers.ListField(child=serializers.CharField())
    agrees = serializers.BooleanField(
        allow_null=True,
        help_text="Whether the other part gives the same form; null where it was not asked or is silent.",
    )
    heard = HeardChangeSerializer(many=True)
    probability = serializers.FloatField(
        allow_null=True,
        help_text="That the answer is right, 0 to 1; null where nothing was understood.",
    )
    decision = serializers.ChoiceField(
        choices=["act", "confirm", "ask", "refuse"],
        help_text="What a robot may do: only with act it goes on without a word of the person.",
    )
    sureness = serializers.CharField(help_text="How sure the answer is, in words.")
    spoken = serializers.CharField(
        allow_blank=True,
        help_text="What the robot says by the decision: what it does, or a question.",
    )
    reasons = ReasonSerializer(many=True)
    nearest = serializers.ListField(
        child=serializers.CharField(), help_text="Commands that are near, where it refuses."
    )
    candidates = CandidateSerializer(many=True)


class ParseSerializer(OneAnswerSerializer):
    """The answer to an utterance. Where it holds several commands, the candidate does one after the other."""

    several = OneAnswerSerializer(
        many=True, help_text="The answer to each command, where there are several."
    )
    joint_plan = JointPlanField(
        allow_null=True,
        help_text="One plan of all of them, as docs/reference/recipes.md describes it.",
    )


class ParseRoute(APIView):
    """Parses an utterance, or JSON lines with one each, with what answers in the world."""

    permission_classes = [HasDuty]
    parser_classes = [BoundedJSONParser, *JSON_LINES_PARSERS]
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
            OpenApiParameter(
                "parser", OpenApiTypes.STR, description="Of JSON lines: the parser to ask."
            ),
        ],
        request={"application/json": ParseQuery, JSON_LINES: OpenApiTypes.STR},
        responses={
            (200, "application/json"): ParseSerializer,
            (200, JSON_LINES): OpenApiTypes.STR,
            413: OpenApiResponse(description="More lines than one request may bring."),
            503: OpenApiResponse(
                description="The parse server is away, or still loading; or two batches are at work."
            ),
        },
    )
    def post(self, request: ApiRequest, world: str) -> HttpResponseBase:
        if isinstance(request.data, bytes):
            return self._answer_lines(request, request.data)
        query = ParseQuery(data=request.data)
        query.is_valid(raise_exception=True)
        return Response(client().parse(self.world.name, **query.validated_data))

    def _answer_lines(self, request: ApiRequest, lines: bytes) -> HttpResponseBase:
        query = AskedParser(data=request.query_params)
        query.is_valid(raise_exception=True)
        count = len(numbered_lines(lines))
        if count > MOST_LINES:
            raise Refusal(
                f"There are {count:,} lines; {MOST_LINES:,} are answered at once. Send them in several "
                "batches, or have a worker parse them: POST them to parse/jobs/.",
                "too_many_lines",
                HTTPStatus.REQUEST_ENTITY_TOO_LARGE,
            )
        answers = client().parse_lines(
            self.world.name, lines, **query.validated_data, most_seconds=MOST_SECONDS
        )
        return StreamingHttpResponse(
            _all_of(answers, count), content_type=f"{JSON_LINES}; charset=utf-8"
        )


class ParseJobs(WorldRoute):
    """Lets a worker parse JSON lines. The job says how far it is; ``jobs/ID/result/`` has the answers."""

    parser_classes = JSON_LINES_PARSERS
    model = Job
    filter_backends = []
    duties = {"POST": Duty.VIEW}
    http_method_names = ["post", "options"]

    @extend_schema(
        operation_id="start_parse",
        parameters=[AskedParser],
        request={JSON_LINES: OpenApiTypes.STR},
        responses={202: JobSerializer},
    )
    @once
    def post(self, request: ApiRequest, **kwargs: object) -> Response:
        query = AskedParser(data=request.query_params)
        query.is_valid(raise_exception=True)
        if not isinstance(request.data, bytes) or not request.data.strip():
            raise ValidationError("There is no line to parse.")
        job = request_batch(self.world, request.data, by=request.user, **query.validated_data)
        return accepted(request, job)


def _all_of(answers: Iterator[bytes], count: int) -> Iterator[bytes]:
    """Yield the answers to ``count`` lines. Where they break off, a last line says so.

    Raises BrokenOff after that line.
    """
    answered, reason = 0, AWAY
    try:
        for answer in answers:
            yield answer
            answered += 1
    except ParserAway as error:
        reason = error.message
    if answered < count:
        last = {"error": reason, "answered": answered, "of": count}
        yield json.dumps(last).encode() + b"\n"
        raise BrokenOff(f"{answered:,} of {count:,} lines were answered. {reason}")
