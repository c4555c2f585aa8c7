"""Utterances: what their list shows, and more of them taken in."""

from __future__ import annotations

from typing import Any

from django.db.models import QuerySet
from django.http import StreamingHttpResponse
from django.shortcuts import get_object_or_404
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import extend_schema
from rest_framework import serializers, status
from rest_framework.decorators import action
from rest_framework.response import Response

from annotations.exchange.tables import TableFormat
from annotations.labelling.collecting import MOST_AT_ONCE, collect
from annotations.labelling.entity_spans import mend_span
from annotations.labelling.item_answers import answer
from annotations.labelling.label_export import FIELDS, export_labels
from annotations.labelling.label_formats import LABEL_FILES, LabelFormat
from annotations.labelling.upload_reading import UploadFormat as UploadFormat
from annotations.labelling.utterance_deletion import delete_utterance
from annotations.labelling.utterance_uploads import structure_of
from annotations.language.texts import LanguageError, Refusal
from annotations.models import Duty, Entity, Origin, Upload, Utterance
from annotations.models.corpus import origin_choices
from annotations.people.allowances import may_take_long
from annotations.rows.stored_problems import as_json
from annotations.web.corpus.corpus_filters import UtteranceFilters
from annotations.web.corpus.label_rest import LabelSerializer, NewLabel, NewSpan
from annotations.web.rest.fields import Fields
from annotations.web.rest.idempotency import once
from annotations.web.rest.negotiation import AnyType
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.problem_details import refusal_of_text
from annotations.web.rest.routes import RowsViewSet
from annotations.web.rest.streaming import attachment


class UtteranceSerializer(serializers.ModelSerializer[Utterance]):
    """An utterance with its form, which is empty while nobody has given it one.

    ``spans`` are rows of start, end, class and entity.
    """

    spans = serializers.ListField(child=serializers.ListField())
    created_by = serializers.CharField(source="created_by.username", default=None)

    class Meta:
        model = Utterance
        fields = [
            *("id", "text", "anonymized_text", "spans", "origin", "status", "logical_form"),
            *("version", "upload", "created_by", "created_at"),
        ]


class NewUtterances(Fields):
    """Texts that people said. With an error in one of them nothing is stored."""

    texts = serializers.ListField(
        child=serializers.CharField(trim_whitespace=False, allow_blank=True, max_length=5_000),
        max_length=MOST_AT_ONCE,
    )
    origin = serializers.ChoiceField(choices=origin_choices(), default=Origin.UPLOADED)


class CollectedSerializer(serializers.Serializer[Any]):
    """What was stored. ``upload`` is the id for ``uploads/ID/undo/``, null if nothing was new."""

    added = serializers.IntegerField()
    duplicates = serializers.ListField(child=serializers.CharField())
    upload = serializers.IntegerField(allow_null=True)


class ExportedLabelSerializer(serializers.Serializer[Any]):
    """An answer that was accepted."""

    annotator = serializers.CharField()
    verdict = serializers.CharField()
    form = serializers.CharField()
    reason = serializers.CharField()
    at = serializers.DateTimeField()
    seconds = serializers.FloatField(allow_null=True)


class ExportedUtteranceSerializer(serializers.ModelSerializer[Utterance]):
    """One line of a JSON Lines export. ``labels`` are the accepted answers; the last one decides, and
    ``annotator``, ``labelled_at`` and ``seconds`` are taken from it."""

    spans = serializers.ListField(child=serializers.ListField())
    file_name = serializers.CharField()
    created_by = serializers.CharField()
    labels = ExportedLabelSerializer(many=True)
    annotator = serializers.CharField()
    labelled_at = serializers.CharField()
    seconds = serializers.FloatField(allow_null=True)

    class Meta:
        model = Utterance
        fields = FIELDS


class LabelExportQuery(serializers.Serializer[Any]):
    """The format of an export."""

    def get_fields(self) -> dict[str, Any]:
        # "as" is a word of Python and cannot be a class attribute.
        formats = [*TableFormat, *LabelFormat]
        return {"as": serializers.ChoiceField(choices=formats, default=TableFormat.JSONL)}


class UtteranceViewSet(RowsViewSet):
    """The utterances, the oldest first. One gets its form from the work queue."""

    model = Utterance
    serializer_class = UtteranceSerializer
    filterset_class = UtteranceFilters
    duties = dict.fromkeys(("create", "destroy", "label", "spans"), Duty.ANNOTATE)
    conditional = ("destroy",)
    sorts = {"id": "pk", "text": "text", "status": "status"}

    def rows(self) -> QuerySet[Utterance]:
        return self.world.utterances.select_related("created_by")

    @extend_schema(request=NewUtterances, responses={201: CollectedSerializer})
    @once
    def create(self, request: ApiRequest, **kwargs: object) -> Response:
        """Takes in new utterances."""
        sent = self.read(NewUtterances)
        try:
            format = structure_of(sent["texts"])
        except LanguageError as error:
            raise refusal_of_text(error, "texts") from error
        if format:
            sentence = (
                f"The texts are the lines of a {format} file, not what people say. Send the file to uploads/, "
                f"which reads it; with format=text there, each line is an utterance."
            )
            problem = {"field": "texts", "message": sentence}
            raise Refusal(sentence, "lines_of_a_file", problems=[problem])
        by = request.user
        upload = Upload(world=self.world, created_by=by, format=UploadFormat.TEXT)
        collected = collect(self.world, sent["texts"], sent["origin"], by, upload)
        if collected.problems:
            problems = [{"field": "texts", **as_json(each)} for each in collected.problems]
            raise Refusal(str(collected.problems[0]), "unreadable_texts", problems=problems)
        values = {
            "added": collected.added,
            "duplicates": list(collected.duplicates),
            "upload": upload.pk,
        }
        return Response(values, status=status.HTTP_201_CREATED)

    @extend_schema(
        operation_id="utterances_export",
        filters=True,
        parameters=[LabelExportQuery],
        responses={
            (200, "application/jsonl"): ExportedUtteranceSerializer(many=True),
            (200, "text/csv"): OpenApiTypes.STR,
            (200, "text/plain"): OpenApiTypes.STR,
            (200, "application/json"): OpenApiTypes.OBJECT,
            (200, "application/vnd.apache.parquet"): OpenApiTypes.BINARY,
            (200, "application/zip"): OpenApiTypes.BINARY,
        },
    )
    @may_take_long
    @action(detail=False, pagination_class=None, content_negotiation_class=AnyType)
    def export(self, request: ApiRequest, **kwargs: object) -> StreamingHttpResponse:
        """Streams the utterances that the filters leave with their labels, as a table or as another program takes them.

        Answers that wait to be compared with another person's are in no export.
        """
        query = LabelExportQuery(data=request.query_params)
        query.is_valid(raise_exception=True)
        as_ = query.validated_data["as"]
        pieces = export_labels(self.world, self.filter_queryset(self.get_queryset()), as_)
        suffix = LABEL_FILES[as_].suffix if as_ in LABEL_FILES else as_
        return attachment(pieces, suffix, f"{self.world.name}-utterances.{suffix}")

    def destroy(self, request: ApiRequest, **kwargs: object) -> Response:
        """Deletes an utterance, which keeps its answers: ``history/utterance/ID/`` restores it with them."""
        row = self.matched()
        delete_utterance(row, request.user, row.version)
        return Response(status=status.HTTP_204_NO_CONTENT)

    @extend_schema(request=NewLabel, responses={201: LabelSerializer})
    @action(detail=True, methods=["post"])
    def label(self, request: ApiRequest, **kwargs: object) -> Response:
        """Answers what an utterance means, whether or not the work queue has asked the caller."""
        row, sent = self.get_object(), self.read(NewLabel)
        values = {name: sent[name] for name in ("verdict", "form", "version", "reason")}
        try:
            made = answer(row, by=request.user, **values)
        except LanguageError as error:
            raise refusal_of_text(error, "form") from error
        return Response(LabelSerializer(made).data, status=status.HTTP_201_CREATED)

    @extend_schema(request=NewSpan, responses={200: UtteranceSerializer})
    @action(detail=True, methods=["post"])
    def spans(self, request: ApiRequest, **kwargs: object) -> Response:
        """Says which words of an utterance name which entity; unlabelled utterances with these words follow."""
        row, sent = self.get_object(), self.read(NewSpan)
        entities = Entity.objects.filter(ontology__world=self.world)
        entity = get_object_or_404(entities, pk=sent["entity"])
        where = sent["start"], sent["end"]
        return self.show(mend_span(row, *where, entity, request.user, sent["version"]))
