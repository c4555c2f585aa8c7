"""What pages say of a corpus as a whole: complexity, what lacks a form, conflicts, leaks, changes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from typing import Any, ClassVar

from django.db.models import QuerySet
from django.shortcuts import get_object_or_404
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiParameter, extend_schema, extend_schema_field
from rest_framework import serializers
from rest_framework.exceptions import ValidationError
from rest_framework.filters import BaseFilterBackend
from rest_framework.request import Request
from rest_framework.response import Response

from annotations.api.problems import ProblemItemSerializer
from annotations.api.reading import Fields, LineField
from annotations.api.routes import WorldRoute
from annotations.generation.complexity import complexity
from annotations.generation.conflicts import conflicts_of
from annotations.generation.uncovered import uncovered_of
from annotations.models import Command, SemanticTemplate, Split, TaskCategory
from annotations.rows.problems import as_json
from annotations.splits.renewing import changes_since
from annotations.splits.split_statistics import near_duplicates_of
from annotations.views.corpus.splits import MOST_CHANGES, MOST_SHOWN

MOST_UNCOVERED = 1_000  # commands of an answer


class ComplexitySerializer(serializers.Serializer):
    """A column of the table of complexity; ``task_category`` is empty for all together. Lengths in tokens."""

    task_category = serializers.CharField(allow_blank=True)
    templates = serializers.IntegerField()
    commands = serializers.IntegerField()
    forms = serializers.IntegerField()
    mean_command_length = serializers.FloatField(allow_null=True)
    mean_form_length = serializers.FloatField(allow_null=True)
    commands_per_form = serializers.FloatField(allow_null=True)


class ComplexityTable(serializers.Serializer):
    results = ComplexitySerializer(many=True)


class Figures(WorldRoute):
    """Figures of a whole world, worked out when they are asked for."""

    filter_backends: ClassVar[list[type[BaseFilterBackend]]] = []
    pagination_class = None


class ComplexityOfWorld(Figures):
    """Shows how long and how varied the commands of each task category are."""

    model = Command

    @extend_schema(operation_id="complexity", responses={200: ComplexityTable})
    def get(self, request: Request, **kwargs: object) -> Response:
        return Response(ComplexityTable({"results": complexity(self.world)}).data)


class UncoveredCommandSerializer(serializers.Serializer):
    """A command without a form, and the nonterminals that a derivation of it goes through."""

    text = serializers.CharField()
    task_category = serializers.CharField()
    nonterminals = serializers.ListField(child=serializers.CharField())


class ShareSerializer(serializers.Serializer):
    """How many of the commands that go through a nonterminal have no form."""

    nonterminal = serializers.CharField()
    commands = serializers.IntegerField()
    uncovered = serializers.IntegerField()


class UncoveredSerializer(serializers.Serializer):
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
    def get(self, request: Request, **kwargs: object) -> Response:
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


class ConflictSerializer(serializers.Serializer):
    """``count`` commands that both templates make, such as ``command``; the form of ``kept`` wins."""

    task_category = serializers.CharField()
    kept = serializers.IntegerField(source="kept.pk")
    lost = serializers.IntegerField(source="lost.pk")
    command = serializers.CharField()
    count = serializers.IntegerField()


class ConflictsSerializer(serializers.Serializer):
    """Pairs of templates; ``trouble`` says why they could not be worked out."""

    results = ConflictSerializer(source="pairs", many=True)
    trouble = serializers.CharField(allow_blank=True)


class Conflicts(Figures):
    """Lists the pairs of templates that give one command different forms."""

    model = SemanticTemplate

    @extend_schema(operation_id="conflicts", responses={200: ConflictsSerializer})
    def get(self, request: Request, **kwargs: object) -> Response:
        return Response(ConflictsSerializer(conflicts_of(self.world)).data)


class FiguresOfSplit(Figures):
    model = Split

    def rows(self) -> QuerySet[Split]:
        return self.world.splits.select_related("world", "follows")

    def figures(self, make: Callable[[Split], Any]) -> Any:
        """Return figures of the split. LanguageError, where they cannot be made, is a 400."""
        return make(get_object_or_404(self.rows(), pk=self.kwargs["pk"]))


class NearDuplicateSerializer(serializers.Serializer):
    """An utterance and the closest one of training; ``similarity`` is a fraction of 1."""

    utterance = serializers.CharField()
    training = serializers.CharField()
    similarity = serializers.FloatField()


class NearDuplicatesSerializer(serializers.Serializer):
    """Of a part: ``shared`` of its ``pairs`` training nearly has; the most similar ones are in ``examples``."""

    part = serializers.CharField(source="leak.part")
    pairs = serializers.IntegerField(source="leak.pairs")
    shared = serializers.IntegerField(source="leak.shared")
    examples = serializers.SerializerMethodField()

    @extend_schema_field(NearDuplicateSerializer(many=True))
    def get_examples(self, each: Any) -> list[dict[str, Any]]:
        return [asdict(one) for one in each.duplicates[:MOST_SHOWN]]


class NearDuplicatesTable(serializers.Serializer):
    results = NearDuplicatesSerializer(many=True)


class NearDuplicatesOfSplit(FiguresOfSplit):
    """Lists utterances of validation and test that training nearly has."""

    @extend_schema(operation_id="near_duplicates", responses={200: NearDuplicatesTable})
    def get(self, request: Request, **kwargs: object) -> Response:
        found = self.figures(near_duplicates_of)
        return Response(NearDuplicatesTable({"results": found}).data)


class PartChangesSerializer(serializers.Serializer):
    """Examples of one part; ``moved`` ones come from another part."""

    part = serializers.CharField()
    added = serializers.IntegerField()
    removed = serializers.IntegerField()
    relabelled = serializers.IntegerField()
    moved = serializers.IntegerField()


class RelabelledSerializer(serializers.Serializer):
    """An utterance with its label in the split and that of today."""

    utterance = serializers.CharField()
    part = serializers.CharField()
    before = serializers.CharField()
    now = serializers.CharField()


class SplitChangesSerializer(serializers.Serializer):
    """What ``renew/`` would change; some of the labels that differ are in ``relabelled``."""

    parts = PartChangesSerializer(many=True)
    relabelled = serializers.SerializerMethodField()

    @extend_schema_field(RelabelledSerializer(many=True))
    def get_relabelled(self, changes: Any) -> list[dict[str, Any]]:
        return [asdict(each) for each in changes.relabelled[:MOST_CHANGES]]


class ChangesOfSplit(FiguresOfSplit):
    """Says what freezing a split anew would change."""

    @extend_schema(operation_id="split_changes", responses={200: SplitChangesSerializer})
    def get(self, request: Request, **kwargs: object) -> Response:
        return Response(SplitChangesSerializer(self.figures(changes_since)).data)
