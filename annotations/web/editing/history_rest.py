"""History of the rows that people edit: list versions, restore one, rename."""

from __future__ import annotations

from typing import Any

from django.db.models import QuerySet
from django.http import Http404
from django.shortcuts import get_object_or_404
from django.utils.module_loading import import_string
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.response import Response

from annotations.editing.edits import restore
from annotations.editing.rename_plans import PLANS
from annotations.editing.world_rename import rename
from annotations.language.texts import MAX_ENTITY
from annotations.models import Duty, SemanticTemplate
from annotations.rows.history import DELETED, history_of, what_happened
from annotations.rows.row_kinds import KINDS, EditableKind
from annotations.web.editing.kinds_of_rows import RESTORING, kind_named
from annotations.web.editing.rename_forms import RenameForm
from annotations.web.rest.fields import Fields, LineField
from annotations.web.rest.idempotency import once
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.problem_details import refusal_of_form
from annotations.web.rest.routes import Route, RowRoute, RowsRoute

# Kind of row → the serializer of its own routes. By path: the rooms of the rows import this one.
SERIALIZERS = {
    "template": "annotations.web.description.template_rest.TemplateSerializer",
    "task_category": "annotations.web.description.category_rest.TaskCategorySerializer",
    "production": "annotations.web.description.production_rest.ProductionSerializer",
    "entity": "annotations.web.description.entity_rest.EntitySerializer",
    "entity_class": "annotations.web.description.class_rest.EntityClassSerializer",
    "predicate": "annotations.web.description.predicate_rest.PredicateSerializer",
    "recipe": "annotations.web.description.recipe_rest.RecipeSerializer",
    "primitive": "annotations.web.description.recipe_rest.PrimitiveSerializer",
    "guidelines": "annotations.web.description.guidelines_rest.GuidelinesSerializer",
    "paraphrase": "annotations.web.corpus.paraphrase_rest.ParaphraseSerializer",
    "utterance": "annotations.web.corpus.utterance_rest.UtteranceSerializer",
}


def serializer_of(kind: EditableKind) -> type[serializers.ModelSerializer[Any]]:
    """Return the class that shows rows of ``kind`` at their own address."""
    serializer: type[serializers.ModelSerializer[Any]] = import_string(SERIALIZERS[kind.name])
    return serializer


class VersionSerializer(serializers.Serializer[Any]):
    """A version of a row: its ``values`` as people edit them, its author and its time."""

    entry = serializers.IntegerField(source="history_id")
    id = serializers.IntegerField()
    version = serializers.IntegerField()
    what = serializers.SerializerMethodField()
    by = serializers.CharField(source="history_user.username", default=None, allow_null=True)
    at = serializers.DateTimeField(source="history_date")
    is_deletion = serializers.SerializerMethodField()
    values = serializers.SerializerMethodField()

    def get_what(self, entry: Any) -> str:
        return what_happened(entry)

    def get_is_deletion(self, entry: Any) -> bool:
        return bool(entry.history_type == DELETED)

    def get_values(self, entry: Any) -> dict[str, Any]:
        return {name: getattr(entry, name) for name in self.context["kind"].model.edited_fields}


class OfKind(Route):
    """Routes whose address names a kind of row, such as ``template``."""

    def kind(self) -> EditableKind:
        """Return the kind of the address. Raises Http404."""
        return kind_named(self.kwargs["kind"])


class Versions(OfKind, RowsRoute):
    model = history_of(SemanticTemplate).model  # any of them, for the schema
    serializer_class = VersionSerializer
    sorts = {"newest": "-history_id"}

    def get_serializer_context(self) -> dict[str, Any]:
        context = dict(super().get_serializer_context())
        is_described = getattr(self, "swagger_fake_view", False)
        return context if is_described else {**context, "kind": self.kind()}


class RestoredEntry(Fields):
    """The entry of the history that the row becomes again."""

    entry = serializers.IntegerField(min_value=1, max_value=2**63 - 1)


class RestoredSerializer(serializers.Serializer[Any]):
    """The row as it is now: ``row`` is what its own address shows."""

    kind = serializers.CharField()
    row = serializers.DictField()


class HistoryOfRow(Versions):
    """Lists the versions of a row, the newest first, and restores one; a deleted row comes back."""

    duties = {"POST": Duty.ANNOTATE}

    @property
    def duty(self) -> Duty:
        """Return the duty that the request needs; to restore a row, the duty for writing its kind."""
        kind = KINDS.get(self.kwargs.get("kind", ""))
        return kind.write_duty if kind and self.request.method == "POST" else super().duty

    def rows(self) -> QuerySet[Any]:
        kind, key = self.kind(), self.kwargs["pk"]
        entries = kind.entries_of(self.world).filter(id=key)
        if not entries.exists() and not kind.rows_of(self.world).filter(pk=key).exists():
            raise Http404("There is no such row.")
        return entries

    @extend_schema(request=RestoredEntry, responses={200: RestoredSerializer})
    @once
    def post(self, request: ApiRequest, **kwargs: object) -> Response:
        kind, entries = self.kind(), self.rows()
        entry = get_object_or_404(entries, history_id=self.read(RestoredEntry)["entry"])
        row = RESTORING.get(kind.model, restore)(entry, request.user)
        return Response({"kind": kind.name, "row": serializer_of(kind)(row).data})


class Deleted(Versions):
    """Lists the rows of a kind that were deleted, the latest first."""

    def rows(self) -> QuerySet[Any]:
        return self.kind().deletions_in(self.world)


class NewName(Fields):
    """``old`` says which name, where the row has several: an entity and its aliases."""

    new = LineField(max_length=MAX_ENTITY)
    old = LineField(max_length=MAX_ENTITY, required=False)


class RenamedSerializer(serializers.Serializer[Any]):
    """The row, and how many rows of each kind changed with its name."""

    kind = serializers.CharField()
    row = serializers.DictField()
    changed = serializers.DictField(child=serializers.IntegerField())


class Rename(OfKind, RowRoute):
    """Gives an entity, a predicate or the nonterminal of a production another name, wherever it stands."""

    model = SemanticTemplate
    http_method_names = ["post", "options"]
    duties = {"POST": Duty.ANNOTATE}
    conditional = ("POST",)

    def get_serializer_class(self) -> Any:
        return serializer_of(self.kind())

    def rows(self) -> QuerySet[Any]:
        if self.kind().model not in PLANS:
            raise Http404("Rows of this kind have no name.")
        return self.kind().rows_of(self.world)

    @extend_schema(request=NewName, responses={200: RenamedSerializer})
    def post(self, request: ApiRequest, **kwargs: object) -> Response:
        row, sent = self.matched(), self.read(NewName)
        asked = {"version": row.version, "old": RenameForm(row).initial["old"], **sent}
        form = RenameForm(row, asked)
        if not form.is_valid():
            raise refusal_of_form(form)
        names = form.cleaned_data["old"], form.cleaned_data["new"]
        touched = rename(row, *names, request.user, row.version)
        shown = self.get_serializer(self.get_object()).data
        changed = {each.noun: len(each) for each in touched}
        return Response({"kind": self.kind().name, "row": shown, "changed": changed})
