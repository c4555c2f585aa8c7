"""How people say the commands."""

from __future__ import annotations

from typing import Any

from django.db.models import QuerySet
from django.http import StreamingHttpResponse
from django.shortcuts import get_object_or_404
from drf_spectacular.utils import PolymorphicProxySerializer, extend_schema
from rest_framework import serializers
from rest_framework.decorators import action
from rest_framework.response import Response

from annotations.editing.edits import delete
from annotations.exchange.rephrased_export import RephrasedExport, RephrasedFormat
from annotations.labelling.label_decisions import correct_label
from annotations.language.texts import MAX_FORM
from annotations.models import Duty, Paraphrase
from annotations.models.splits import part_choices
from annotations.people.allowances import may_take_long
from annotations.web.corpus.corpus_filters import ParaphraseFilters
from annotations.web.rest.fields import Fields
from annotations.web.rest.negotiation import AnyType
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import RowsViewSet
from annotations.web.rest.streaming import attachment


class ParaphraseSerializer(serializers.ModelSerializer[Paraphrase]):
    """How somebody said a prompt. Distances are to the prompt; ``command`` is the one behind it."""

    command = serializers.IntegerField(source="command_id", allow_null=True)

    class Meta:
        model = Paraphrase
        fields = [
            *("id", "prompt", "utterance", "grounded_form", "logical_form", "status", "command"),
            *("edit_distance", "jaccard_distance", "position", "version"),
        ]


class LabelChange(Fields):
    """The right label, in any notation. Whoever the work queue asks about labels may correct one."""

    logical_form = serializers.CharField(max_length=MAX_FORM)


class RephrasedQuery(serializers.Serializer[Any]):
    """What may be asked of an export. ``split`` is the number of a split; then only what is in its ``part``, by
    default the training part, is exported."""

    split = serializers.IntegerField(required=False, min_value=1)
    part = serializers.ChoiceField(choices=part_choices(), required=False)

    def get_fields(self) -> dict[str, Any]:
        # "as" is a word of Python and cannot be a class attribute.
        as_ = serializers.ChoiceField(choices=RephrasedFormat.choices, default=RephrasedFormat.CHAT)
        return {"as": as_, **super().get_fields()}


class MessageSerializer(serializers.Serializer[Any]):
    """One turn of a conversation."""

    role = serializers.ChoiceField(choices=["system", "user", "assistant"])
    content = serializers.CharField()


class ChatCaseSerializer(serializers.Serializer[Any]):
    """A line of ``chat``. The assistant answers with the steps as JSON."""

    messages = MessageSerializer(many=True)


class PairCaseSerializer(serializers.Serializer[Any]):
    """A line of ``pairs``: ``target`` is the plan in one line."""

    utterance = serializers.CharField()
    target = serializers.CharField()


class CaseSerializer(serializers.Serializer[Any]):
    """A line of ``tests``: ``expected`` is a task plan; ``part`` is that of the split, if one was named."""

    id = serializers.IntegerField()
    command = serializers.CharField()
    input = serializers.CharField()
    source = serializers.CharField()  # type: ignore[assignment]  # the name of a key
    part = serializers.CharField(allow_blank=True)
    form = serializers.CharField()
    expected = serializers.DictField()


class ParaphraseViewSet(RowsViewSet):
    """The paraphrases."""

    model = Paraphrase
    serializer_class = ParaphraseSerializer
    change_serializer = LabelChange
    duties = {"destroy": Duty.ANNOTATE}
    conditional = ("partial_update", "destroy")
    filterset_class = ParaphraseFilters
    sorts = {
        **{"position": "position", "utterance": "utterance", "prompt": "prompt"},
        **{"edit_distance": "edit_distance", "jaccard_distance": "jaccard_distance"},
    }

    def rows(self) -> QuerySet[Paraphrase]:
        return self.world.paraphrases.all()

    @extend_schema(
        operation_id="paraphrases_export",
        filters=True,
        parameters=[RephrasedQuery],
        responses={
            (200, "application/jsonl"): PolymorphicProxySerializer(
                "RephrasedCase",
                [ChatCaseSerializer, PairCaseSerializer, CaseSerializer],
                resource_type_field_name=None,
                many=True,
            )
        },
    )
    @may_take_long
    @action(detail=False, pagination_class=None, content_negotiation_class=AnyType)
    def export(self, request: ApiRequest, **kwargs: object) -> StreamingHttpResponse:
        """Streams the accepted paraphrases that the filters leave with their plans in the team's primitives."""
        query = RephrasedQuery(data=request.query_params)
        query.is_valid(raise_exception=True)
        asked = query.validated_data
        key = asked.get("split")
        split = get_object_or_404(self.world.splits, pk=key) if key else None
        rows = self.filter_queryset(self.get_queryset())
        export = RephrasedExport(self.world, rows, asked["as"], split, asked.get("part"))
        return attachment(export.pieces(), "jsonl", export.file_name)

    def partial_update(self, request: ApiRequest, **kwargs: object) -> Response:
        """Corrects the label of a paraphrase."""
        row = self.matched()
        form = self.read(LabelChange)["logical_form"]
        return self.show(correct_label(row, form, request.user, row.version))

    def destroy(self, request: ApiRequest, **kwargs: object) -> Response:
        """Deletes a paraphrase."""
        row = self.matched()
        delete(row, request.user, row.version)
        return Response(status=204)
