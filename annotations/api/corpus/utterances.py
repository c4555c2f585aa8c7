"""Utterances: what their list shows, and more of them taken in."""

from __future__ import annotations

from typing import ClassVar

from django.db.models import QuerySet
from drf_spectacular.utils import extend_schema
from rest_framework import serializers, status
from rest_framework.request import Request
from rest_framework.response import Response

from annotations.api.once import once
from annotations.api.problems import Refused
from annotations.api.reading import Fields
from annotations.api.routes import RowRoute, RowsRoute
from annotations.labelling import collect
from annotations.labelling.collecting import MOST_AT_ONCE
from annotations.lists.filters import UtteranceFilters
from annotations.models import Duty, Origin, Utterance
from annotations.models.corpus import origin_choices
from annotations.rows.problems import as_json


class UtteranceSerializer(serializers.ModelSerializer):
    """An utterance with its form, which is empty while nobody has given it one.

    ``spans`` are rows of start, end, class and entity.
    """

    spans = serializers.ListField(child=serializers.ListField())
    created_by = serializers.CharField(source="created_by.username", default=None)

    class Meta:
        model = Utterance
        fields = [
            *("id", "text", "anonymized_text", "spans", "origin", "status", "logical_form"),
            *("version", "created_by", "created_at"),
        ]


class NewUtterances(Fields):
    """Texts that people said. With an error in one of them nothing is stored."""

    texts = serializers.ListField(
        child=serializers.CharField(trim_whitespace=False, allow_blank=True, max_length=5_000),
        max_length=MOST_AT_ONCE,
    )
    origin = serializers.ChoiceField(choices=origin_choices(), default=Origin.UPLOADED)


class CollectedSerializer(serializers.Serializer):
    added = serializers.IntegerField()
    duplicates = serializers.ListField(child=serializers.CharField())


class UtteranceNoun:
    model = Utterance
    serializer_class = UtteranceSerializer

    def rows(self) -> QuerySet[Utterance]:
        return self.world.utterances.select_related("created_by")


class Utterances(UtteranceNoun, RowsRoute):
    """Lists utterances, the oldest first, and takes new ones in."""

    filterset_class = UtteranceFilters
    duties: ClassVar[dict[str, Duty]] = {"POST": Duty.ANNOTATE}
    sorts = {"id": "pk", "text": "text", "status": "status"}

    @extend_schema(request=NewUtterances, responses={201: CollectedSerializer})
    @once
    def post(self, request: Request, **kwargs: object) -> Response:
        sent = self.read(NewUtterances)
        collected = collect(self.world, sent["texts"], sent["origin"], request.user)
        if collected.problems:
            problems = [{"field": "texts", **as_json(each)} for each in collected.problems]
            raise Refused(str(collected.problems[0]), problems)
        values = {"added": collected.added, "duplicates": list(collected.duplicates)}
        return Response(values, status=status.HTTP_201_CREATED)


class OneUtterance(UtteranceNoun, RowRoute):
    """Shows one utterance. It gets its form from the work queue."""
