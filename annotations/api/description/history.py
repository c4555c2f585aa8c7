"""What became of the rows that people edit: versions, restored ones, other names."""

from __future__ import annotations

from typing import Any, ClassVar

from django.db.models import QuerySet
from django.http import Http404
from django.shortcuts import get_object_or_404
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.request import Request
from rest_framework.response import Response

from annotations.api.corpus.paraphrases import ParaphraseSerializer
from annotations.api.corpus.utterances import UtteranceSerializer
from annotations.api.description.entities import EntitySerializer
from annotations.api.description.predicates import PredicateSerializer
from annotations.api.description.productions import ProductionSerializer
from annotations.api.description.templates import TemplateSerializer
from annotations.api.once import once
from annotations.api.problems import refusal_of_form
from annotations.api.reading import Fields, LineField
from annotations.api.routes import RowRoute, RowsRoute
from annotations.editing.edits import restore
from annotations.language.limits import MAX_ENTITY
from annotations.models import Duty, SemanticTemplate
from annotations.renaming import PLANS, rename
from annotations.rows.history import DELETED, history_of, what_happened
from annotations.rows.kinds import Kind
from annotations.views.description.world_forms import RenameForm
from annotations.views.editing.history import RESTORING, kind_named

SERIALIZERS = {
    "template": TemplateSerializer,
    "production": ProductionSerializer,
    "entity": EntitySerializer,
    "predicate": PredicateSerializer,
    "paraphrase": ParaphraseSerializer,
    "utterance": UtteranceSerializer,
}


class VersionSerializer(serializers.Serializer):
    """What a row was: ``values`` as people edit them, who made it so, and when."""

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
        return entry.history_type == DELETED

    def get_values(self, entry: Any) -> dict[str, Any]:
        return {name: getattr(entry, name) for name in self.context["kind"].model.edited_fields}


class OfKind:
    """Routes whose address names a kind of row, such as ``template``."""

    def kind(self) -> Kind:
        """Return the kind of the address. Raises Http404."""
        return kind_named(self.kwargs["kind"])


class Versions(OfKind, RowsRoute):
    model = history_of(SemanticTemplate).model  # any of them, for the schema
    serializer_class = VersionSerializer
    sorts = {"newest": "-history_id"}

    def get_serializer_context(self) -> dict[str, Any]:
        context = super().get_serializer_context()
        is_described = getattr(self, "swagger_fake_view", False)
        return context if is_described else {**context, "kind": self.kind()}


class RestoredEntry(Fields):
    """The entry of the history that the row becomes again."""

    entry = serializers.IntegerField(min_value=1, max_value=2**63 - 1)


class RestoredSerializer(serializers.Serializer):
    """The row as it is now: ``row`` is what its own address shows."""

    kind = serializers.CharField()
    row = serializers.DictField()


class History(Versions):
    """Lists the versions of a row, the newest first, and restores one; a deleted row comes back."""

    duties: ClassVar[dict[str, Duty]] = {"POST": Duty.ANNOTATE}

    def rows(self) -> QuerySet[Any]:
        rows = self.kind().entries_of(self.world).filter(id=self.kwargs["pk"])
        if not rows.exists() and not self._is_there():
            raise Http404("There is no such row.")
        return rows

    def _is_there(self) -> bool:
        return self.kind().rows_of(self.world).filter(pk=self.kwargs["pk"]).exists()

    @extend_schema(request=RestoredEntry, responses={200: RestoredSerializer})
    @once
    def post(self, request: Request, **kwargs: object) -> Response:
        kind, entries = self.kind(), self.rows()
        entry = get_object_or_404(entries, history_id=self.read(RestoredEntry)["entry"])
        row = RESTORING.get(kind.model, restore)(entry, request.user)
        return Response({"kind": kind.name, "row": SERIALIZERS[kind.name](row).data})


class Deleted(Versions):
    """Lists the rows of a kind that were deleted, the latest first."""

    def rows(self) -> QuerySet[Any]:
        return self.kind().deletions_in(self.world)


class NewName(Fields):
    """``old`` says which name, where the row has several: an entity and its aliases."""

    new = LineField(max_length=MAX_ENTITY)
    old = LineField(max_length=MAX_ENTITY, required=False)


class RenamedSerializer(serializers.Serializer):
    """The row, and how many rows of each kind changed with its name."""

    kind = serializers.CharField()
    row = serializers.DictField()
    changed = serializers.DictField(child=serializers.IntegerField())


class Rename(OfKind, RowRoute):
    """Gives an entity, a predicate or the nonterminal of a production another name, wherever it stands."""

    model = SemanticTemplate
    http_method_names = ["post", "options"]
    duties: ClassVar[dict[str, Duty]] = {"POST": Duty.ANNOTATE}
    conditional_methods = ("POST",)

    def get_serializer_class(self) -> Any:
        return SERIALIZERS[self.kind().name]

    def rows(self) -> QuerySet[Any]:
        if self.kind().model not in PLANS:
            raise Http404("Rows of this kind have no name.")
        return self.kind().rows_of(self.world)

    @extend_schema(request=NewName, responses={200: RenamedSerializer})
    def post(self, request: Request, **kwargs: object) -> Response:
        row, sent = self.matched(), self.read(NewName)
        form = RenameForm(row, {"version": row.version, **sent})
        form.data.setdefault("old", form.initial["old"])
        if not form.is_valid():
            raise refusal_of_form(form)
        names = form.cleaned_data["old"], form.cleaned_data["new"]
        touched = rename(row, *names, request.user, row.version)
        shown = self.get_serializer(self.get_object()).data
        changed = {each.noun: len(each) for each in touched}
        return Response({"kind": self.kind().name, "row": shown, "changed": changed})
