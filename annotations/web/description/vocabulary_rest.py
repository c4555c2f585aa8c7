"""The words of a world, for a speech recogniser."""

from __future__ import annotations

from typing import Any

from django.http import StreamingHttpResponse
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import extend_schema
from rest_framework import serializers

from annotations.exchange.vocabulary_export import (
    PhraseKind,
    VocabularyFormat,
    VocabularyPart,
    vocabulary_file,
    vocabulary_of,
    vocabulary_pieces,
)
from annotations.models import Entity
from annotations.people.allowances import may_take_long
from annotations.web.rest.negotiation import AnyType
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import WorldRoute
from annotations.web.rest.streaming import attachment


class PhraseSerializer(serializers.Serializer[Any]):
    """A line of ``jsonl``. ``entity_class`` and ``entity`` say what is named; both are empty for a word of the
    grammar."""

    text = serializers.CharField()
    kind = serializers.ChoiceField(choices=[*PhraseKind])
    entity_class = serializers.CharField(allow_blank=True)
    entity = serializers.CharField(allow_blank=True)


class VocabularyQuery(serializers.Serializer[Any]):
    """Which phrases, and how they are written; all of them, one a line, where nothing is asked."""

    only = serializers.ChoiceField(choices=VocabularyPart.choices, required=False)

    def get_fields(self) -> dict[str, Any]:
        # "as" is a word of Python and cannot be a class attribute.
        as_ = serializers.ChoiceField(
            choices=VocabularyFormat.choices, default=VocabularyFormat.TXT
        )
        return {"as": as_, **super().get_fields()}


@may_take_long
class Vocabulary(WorldRoute):
    """Streams names, aliases, plurals and the fixed words of the grammar: hot words for a speech recogniser."""

    model = Entity
    content_negotiation_class = AnyType

    @extend_schema(
        operation_id="vocabulary",
        parameters=[VocabularyQuery],
        responses={
            (200, "text/plain"): OpenApiTypes.STR,
            (200, "application/jsonl"): PhraseSerializer(many=True),
            (200, "application/json"): {"type": "array", "items": {"type": "string"}},
        },
    )
    def get(self, request: ApiRequest, **kwargs: object) -> StreamingHttpResponse:
        query = VocabularyQuery(data=request.query_params)
        query.is_valid(raise_exception=True)
        as_, only = query.validated_data["as"], query.validated_data.get("only")
        phrases = vocabulary_of(self.world, only)
        name = vocabulary_file(self.world, as_)
        return attachment(vocabulary_pieces(phrases, as_), name.rpartition(".")[2], name)
