"""Routes of commands without a form, and of commands to which two templates give different forms."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiParameter, extend_schema
from rest_framework import serializers
from rest_framework.exceptions import ValidationError
from rest_framework.response import Response

from annotations.generation.conflicts import conflicts_of
from annotations.generation.uncovered import uncovered_of
from annotations.models import SemanticTemplate, TaskCategory
from annotations.rows.stored_problems import as_json
from annotations.web.rest.fields import Fields, LineField
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.problem_details import ProblemItemSerializer
from annotations.web.rest.routes import Figures

MOST_UNCOVERED = 1_000  # commands of an answer


class UncoveredCommandSerializer(serializers.Serializer[Any]):
    """A command without a form, and the nonterminals that a derivation of it goes through."""

    text = serializers.CharField()
    task_category = serializers.CharField()
    nonterminals = serializers.ListField(child=serializers.CharField())


class ShareSerializer(serializers.Serializer[Any]):
    """How many of the commands that go through a nonterminal have no form."""

    nonterminal = serializers.CharField()
    commands = serializers.IntegerField()
    uncovered = serializers.IntegerField()


class UncoveredSerializer(serializers.Serializer[Any]):
    """``count`` commands without a form, the first of which are in ``results``. Of the task categories in
    ``cut`` only a part was looked at; ``problems`` say which could not be looked at."""

    count = serializers.IntegerField()
    results = UncoveredCommandSerializer(many=True)
    shares = ShareSerializer(many=True)
    cut = serializers.ListField(child=serializers.CharField())
    problems = ProblemItemSerializer(many=True)


class UncoveredQuery(Fields):
    task_category = LineField(max_length=60, default="", allow_blank=True)
    nonterminal = LineField(max_length=200, default="", allow_blank=True)
    q = serializers.CharField(max_length=200, default="", allow_blank=True)


class Uncovered(Figures):
    """Lists the commands of the grammar that no template gives a form, and where they gather."""

    model = TaskCategory

    @extend_schema(
        operation_id="uncovered",
        parameters=[
            OpenApiParameter(name, OpenApiTypes.STR)
            for name in ("task_category", "nonterminal", "q")
        ],
        responses={200: UncoveredSerializer},
    )
    def get(self, request: ApiRequest, **kwargs: object) -> Response:
        query = UncoveredQuery(data=request.query_params)
        query.is_valid(raise_exception=True)
        asked = query.validated_data
        categories = TaskCategory.objects.filter(grammar__world=self.world)
        name = asked["task_category"]
        if name and not categories.filter(name=name).exists():
            raise ValidationError({"task_category": ["There is no such task category."]})
        report = uncovered_of(self.world, name)
        commands = report.matching(asked["nonterminal"], asked["q"])
        shown = [
            {**asdict(each), "nonterminals": sorted(each.nonterminals)}
            for each in commands[:MOST_UNCOVERED]
        ]
        answer = {
            "count": len(commands),
            "results": shown,
            "shares": [asdict(each) for each in report.shares],
            "cut": report.cut,
            "problems": [as_json(each) for each in report.problems],
        }
        return Response(UncoveredSerializer(answer).data)


class ConflictSerializer(serializers.Serializer[Any]):
    """``count`` commands that both templates make, such as ``command``; the form of ``kept`` wins."""

    task_category = serializers.CharField()
    kept = serializers.IntegerField(source="kept.pk")
    lost = serializers.IntegerField(source="lost.pk")
    command = serializers.CharField()
    count = serializers.IntegerField()


class ConflictsSerializer(serializers.Serializer[Any]):
    """Pairs of templates; ``trouble`` says why they could not be worked out."""

    results = ConflictSerializer(source="pairs", many=True)
    trouble = serializers.CharField(allow_blank=True)


class Conflicts(Figures):
    """Lists the pairs of templates that give one command different forms."""

    model = SemanticTemplate

    @extend_schema(operation_id="conflicts", responses={200: ConflictsSerializer})
    def get(self, request: ApiRequest, **kwargs: object) -> Response:
        return Response(ConflictsSerializer(conflicts_of(self.world)).data)
