"""Uploads of utterances: looked at, stored, undone and redone as a whole."""

from __future__ import annotations

from http import HTTPStatus
from typing import Any

from django.db.models import QuerySet
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.decorators import action
from rest_framework.exceptions import PermissionDenied
from rest_framework.response import Response

from annotations.labelling.upload_reading import MOST_BYTES, TABLES, UploadFormat
from annotations.labelling.utterance_uploads import (
    NotNow,
    Preview,
    ReadingChoices,
    content_of,
    count_labelled,
    preview,
    redo,
    store,
    undo,
)
from annotations.language.texts import ENCODINGS, LanguageError, Refusal, normalise_line
from annotations.models import Duty, Upload
from annotations.models.corpus import MOST_CHARACTERS_OF_NAME
from annotations.people.allowances import may_take_long, takes_files
from annotations.rows.stored_problems import as_json
from annotations.web.rest.fields import Fields
from annotations.web.rest.idempotency import once
from annotations.web.rest.parsing import BoundedJSONParser, FilesParser
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.problem_details import (
    ProblemItemSerializer,
    refusal_of_text,
)
from annotations.web.rest.routes import Route, RowsViewSet


class UploadSerializer(serializers.ModelSerializer[Upload]):
    """What was sent at once. ``undone_at`` is null while its utterances are here."""

    created_by = serializers.CharField(source="created_by.username", default=None)
    undone_by = serializers.CharField(source="undone_by.username", default=None)

    class Meta:
        model = Upload
        fields = [
            *("id", "file_name", "format", "column", "added", "created_by", "stored_at"),
            *("undone_at", "undone_by"),
        ]


class NewUpload(Fields):
    """A ``file``, or its ``text``. What is left out is recognised: ``format``, the ``column`` with the texts,
    whether the first row of a table is its head (``has_head``), the ``encoding``.

    ``preview`` says what would be stored and stores nothing. ``skips_bad`` leaves out rows that cannot be
    stored; without it one of them refuses the upload. ``as_labels`` makes the forms in the file labels of
    the caller, who has to be an admin.
    """

    file = serializers.FileField(required=False, allow_empty_file=True)
    text = serializers.CharField(
        required=False, trim_whitespace=False, allow_blank=True, max_length=MOST_BYTES
    )
    format = serializers.ChoiceField(choices=[*UploadFormat], required=False)
    column = serializers.CharField(required=False, max_length=MOST_CHARACTERS_OF_NAME)
    has_head = serializers.BooleanField(required=False, allow_null=True, default=None)
    encoding = serializers.ChoiceField(choices=list(ENCODINGS), required=False)
    preview = serializers.BooleanField(default=False)
    skips_bad = serializers.BooleanField(default=False)
    as_labels = serializers.BooleanField(default=False)

    def validate(self, sent: dict[str, Any]) -> dict[str, Any]:
        if ("file" in sent) == ("text" in sent):
            raise serializers.ValidationError({"file": ["Send a file, or a text."]})
        if "file" in sent and sent["file"].size > MOST_BYTES:
            raise serializers.ValidationError(
                {"file": [f"{MOST_BYTES:,} bytes are the limit. Send it in parts."]}
            )
        return sent


class ShownTextSerializer(serializers.Serializer[Any]):
    """One row: ``state`` is new, known (the world has it) or repeated."""

    line = serializers.IntegerField()
    text = serializers.CharField()
    state = serializers.CharField()
    was_cleaned = serializers.BooleanField()


class PreviewSerializer(serializers.Serializer[Any]):
    """How an upload was read, and what came of it: ``upload`` is null for a preview.

    ``ignored`` are columns that are not stored, ``first`` the first ten rows; ``forms`` counts those that
    become labels.
    """

    upload = UploadSerializer(allow_null=True)
    format = serializers.CharField()
    encoding = serializers.CharField()
    columns = serializers.ListField(child=serializers.CharField())
    column = serializers.CharField()
    ignored = serializers.ListField(child=serializers.CharField())
    new = serializers.IntegerField()
    known = serializers.IntegerField()
    repeated = serializers.IntegerField()
    empty = serializers.IntegerField()
    cleaned = serializers.IntegerField()
    bad = serializers.IntegerField()
    forms = serializers.IntegerField()
    bad_forms = serializers.IntegerField()
    warnings = serializers.ListField(child=serializers.CharField())
    problems = ProblemItemSerializer(many=True)
    first = ShownTextSerializer(many=True)


def shown_as_json(shown: Preview, upload: Upload | None) -> dict[str, Any]:
    """Return what ``PreviewSerializer`` describes, of an upload that was stored or, with None, only read."""
    sheet = shown.sheet
    return {
        "upload": UploadSerializer(upload).data if upload else None,
        "format": str(sheet.format),
        "encoding": shown.encoding,
        "columns": list(sheet.columns),
        "column": sheet.column,
        "ignored": list(sheet.ignored),
        "new": shown.n_new,
        "known": shown.n_known,
        "repeated": shown.n_repeated,
        "empty": shown.n_empty,
        "cleaned": shown.n_cleaned,
        "bad": shown.n_problems,
        "forms": len(shown.forms or {}),
        "bad_forms": shown.n_bad_forms,
        "warnings": list(sheet.warnings),
        "problems": [as_json(each) for each in shown.problems],
        "first": ShownTextSerializer(shown.first, many=True).data,
    }


class UndoRequest(Fields):
    """``labelled`` says what becomes of utterances that somebody has answered since the upload, ``world`` what becomes
    of the entities, predicates, productions and templates that its lines have made, all of them."""

    labelled = serializers.ChoiceField(choices=["keep", "delete"], required=False)
    world = serializers.ChoiceField(choices=["keep", "delete"], default="keep")


class UndoneSerializer(serializers.Serializer[Any]):
    """The upload, and how many of its utterances were deleted or restored; ``taken`` stay deleted because
    their texts were added again."""

    upload = UploadSerializer()
    changed = serializers.IntegerField()
    taken = serializers.IntegerField()


class UploadViewSet(RowsViewSet):
    """The uploads, the newest first."""

    model = Upload
    serializer_class = UploadSerializer
    parser_classes = [FilesParser, BoundedJSONParser]
    duties = dict.fromkeys(("create", "undo", "redo"), Duty.ANNOTATE)
    sorts = {"newest": "-pk", "id": "pk"}

    def rows(self) -> QuerySet[Upload]:
        return (
            self.world.uploads.stored().select_related("created_by", "undone_by").defer("content")
        )

    @extend_schema(
        request={"multipart/form-data": NewUpload, "application/json": NewUpload},
        responses={200: PreviewSerializer, 201: PreviewSerializer},
    )
    @takes_files
    @once
    def create(self, request: ApiRequest, **kwargs: object) -> Response:
        """Takes in a file of utterances."""
        sent = self.read(NewUpload)
        if sent["as_labels"] and not self.world.allows(request.user, Duty.MANAGE):
            raise PermissionDenied("Only admins of this world store forms as labels.")
        file = sent.get("file")
        name = normalise_line(file.name) if file else ""
        chosen = ReadingChoices(
            sent.get("format", ""),
            sent.get("column", ""),
            sent.get("encoding", ""),
            sent["has_head"],
            sent["as_labels"],
        )
        try:
            data = content_of(file) if file else sent["text"].encode("utf-8", "replace")
            shown = preview(self.world, data, name, chosen)
        except LanguageError as error:
            raise refusal_of_text(error, "file" if file else "text") from error
        if sent["preview"]:
            return Response(shown_as_json(shown, None))
        _require_storable(shown, sent)
        upload = Upload(file_name=name[-MOST_CHARACTERS_OF_NAME:])
        store(self.world, shown, upload, request.user)
        stored = upload if upload.pk else None
        return Response(shown_as_json(shown, stored), status=HTTPStatus.CREATED)

    @extend_schema(request=UndoRequest, responses={200: UndoneSerializer})
    @may_take_long
    @action(detail=True, methods=["post"], parser_classes=Route.parser_classes)
    def undo(self, request: ApiRequest, **kwargs: object) -> Response:
        """Deletes the utterances of an upload; ``redo/`` brings them back, with their answers."""
        row, sent = self.get_object(), self.read(UndoRequest)
        n_labelled = 0 if row.undone_at else count_labelled(row)
        if n_labelled and "labelled" not in sent:
            raise NotNow(
                f"People have answered {n_labelled:,} of its utterances since. Send labelled=keep or "
                "labelled=delete."
            )
        deleted = undo(
            *(row, request.user),
            with_labelled=sent.get("labelled") == "delete",
            with_world=sent["world"] == "delete",
        )
        return _changed(self.get_object(), deleted)

    @extend_schema(request=None, responses={200: UndoneSerializer})
    @may_take_long
    @action(detail=True, methods=["post"], parser_classes=Route.parser_classes)
    def redo(self, request: ApiRequest, **kwargs: object) -> Response:
        """Restores the utterances of an upload that was undone."""
        restored, n_taken = redo(self.get_object(), request.user)
        return _changed(self.get_object(), restored, n_taken)


def _require_storable(shown: Preview, sent: dict[str, Any]) -> None:
    """Raise Refusal where the caller has to say more, or where a row cannot be stored."""
    sheet = shown.sheet
    if shown.encoding not in ("utf-8", sent.get("encoding", "utf-16")):
        _refuse(
            "encoding",
            f"The file is not UTF-8. If it is {shown.encoding}, say encoding={shown.encoding}.",
        )
    if not sheet.is_column_sure and sheet.format in (
        *TABLES,
        UploadFormat.JSON,
        UploadFormat.JSONL,
    ):
        names = ", ".join(sheet.columns)
        _refuse(
            "column", f"Say which column has the utterances: {names[:300]}; or say format=text."
        )
    if shown.refusal:
        raise Refusal(str(shown.refusal), "unreadable", problems=[as_json(shown.refusal)])
    if shown.problems and not (sent["skips_bad"] and shown.texts):
        problems = [as_json(problem) for problem in shown.problems]
        raise Refusal(str(shown.problems[0]), "bad_rows", problems=problems)


def _refuse(field: str, sentence: str) -> None:
    problem = {"field": field, "message": sentence}
    raise Refusal(sentence, f"{field}_not_said", problems=[problem])


def _changed(row: Upload, changed: int, taken: int = 0) -> Response:
    return Response({"upload": UploadSerializer(row).data, "changed": changed, "taken": taken})
