"""One plan of up to three commands over the API."""

from __future__ import annotations

from typing import Any

from django.http import HttpResponseBase
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.response import Response

from annotations.language.plans import METRES, MOST_COMMANDS, Distances
from annotations.language.texts import MAX_ENTITY
from annotations.models import Scope
from annotations.models.corpus import MOST_CHARACTERS
from annotations.web.rest.fields import Fields, LineField
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import WorldRoute
from parser_service.serving.joint_answers import commands_in, plan_together
from parser_service.web.serving.parsing_rest import MOST_KEY
from parser_service.web.serving.plan_fields import JointPlanField, PlanField
from parser_service.web.serving.tree_query import TreeQuery, tree_answer

MOST_DISTANCES = 10_000
MOST_OF_UNIT = 20


class DistanceSerializer(Fields):
    """How far two places are from each other, in any unit; ``operator`` is where the person is."""

    one = LineField(max_length=MAX_ENTITY)
    other = LineField(max_length=MAX_ENTITY)
    distance = serializers.FloatField(min_value=0, max_value=1e9)


class JointQuery(TreeQuery):
    """One to three ``utterances``, or one ``utterance`` that holds them.

    ``run`` asks another parser than the promoted one; ``as`` xml asks for a behaviour tree, and ``robust``, ``tries``
    and ``seconds`` say how it tries each step. ``unit`` is that of ``distances``. Without those the walk counts rooms:
    a way inside a room is a half.
    """

    utterances = serializers.ListField(
        child=serializers.CharField(max_length=MOST_CHARACTERS),
        max_length=MOST_COMMANDS,
        default=list,
    )
    utterance = serializers.CharField(
        max_length=MOST_COMMANDS * MOST_CHARACTERS, default="", allow_blank=True
    )
    run = serializers.IntegerField(default=None, min_value=1, max_value=MOST_KEY, allow_null=True)
    distances = serializers.ListField(
        child=DistanceSerializer(), max_length=MOST_DISTANCES, default=list
    )
    unit = LineField(max_length=MOST_OF_UNIT, default=METRES)

    def validate(self, sent: dict[str, Any]) -> dict[str, Any]:
        if sent["utterances"] and sent["utterance"]:
            raise serializers.ValidationError("Send utterance or utterances, not both.")
        return sent


class UnderstoodSerializer(serializers.Serializer[Any]):
    """One of the commands, the plan of it alone, and how sure the answer is."""

    utterance = serializers.CharField()
    is_unknown = serializers.BooleanField()
    grounded = serializers.CharField(allow_blank=True)
    english = serializers.CharField(allow_blank=True)
    task_plan = PlanField(help_text="As docs/reference/recipes.md describes it.")
    spoken = serializers.CharField(allow_blank=True)
    decision = serializers.CharField()
    sureness = serializers.CharField()
    probability = serializers.FloatField(allow_null=True)


class JointSerializer(serializers.Serializer[Any]):
    """The commands in the order in which they were said, and one plan of all."""

    commands = UnderstoodSerializer(many=True)
    joint_plan = JointPlanField(help_text="As docs/reference/recipes.md describes it.")
    spoken = serializers.CharField(allow_blank=True)


class JointPlanRoute(WorldRoute):
    """Plans up to three commands together: JSON, or XML for BehaviorTree.CPP 4. Stores nothing."""

    filter_backends = []
    scopes = {"POST": Scope.READ}

    @extend_schema(
        operation_id="joint_plan",
        request=JointQuery,
        responses={
            (200, "application/json"): JointSerializer,
            (200, "application/xml"): OpenApiTypes.STR,
        },
    )
    def post(self, request: ApiRequest, world: str) -> HttpResponseBase:
        sent = self.read(JointQuery)
        utterances = sent["utterances"] or commands_in(self.world, sent["utterance"], sent["run"])
        rows = ((each["one"], each["other"], each["distance"]) for each in sent["distances"])
        distances = Distances.of_rows(rows, sent["unit"])
        answer = plan_together(self.world, utterances, sent["run"], distances)
        if sent["as"] == "xml":
            return tree_answer(answer.plan.plan, sent)
        return Response(answer.as_json())
