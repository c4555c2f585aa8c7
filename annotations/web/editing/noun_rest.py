"""The routes of nouns: what is sent is read by the form of the page, and stored by the same verbs."""

from __future__ import annotations

from collections.abc import Mapping
from http import HTTPStatus
from typing import Any, ClassVar

from django.db.models import QuerySet
from rest_framework.response import Response
from rest_framework.serializers import BaseSerializer

from annotations.editing.edits import change, delete
from annotations.language.texts import Refusal
from annotations.models import Duty, Editable
from annotations.rows.row_kinds import kind_of_model
from annotations.rows.stored_problems import as_json
from annotations.web.editing.kinds_of_rows import DELETING
from annotations.web.editing.noun_forms import NounForm
from annotations.web.rest.idempotency import once, slot_of
from annotations.web.rest.matching import etag_of
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.problem_details import refusal_of_form
from annotations.web.rest.routes import RowsViewSet, WorldRoute


class NounRoute(WorldRoute):
    """A route about the rows of a noun: those that the form of its page edits."""

    noun_form: ClassVar[Any]  # a subclass of NounForm; Any for what it has of its own

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        if hasattr(cls, "noun_form"):
            cls.model = cls.noun_form.model

    def rows(self) -> QuerySet[Any]:
        return kind_of_model(self.noun_form.model).rows_of(self.world)

    def form_of(self, row: Any | None, sent: Mapping[str, Any]) -> Any:
        """Return the form of the page, bound to what was sent over the values of ``row``."""
        stored = self.noun_form.shown(row) if row else {}
        given = {**stored, **self.noun_form.typed(sent)}
        return self.noun_form(self.world, row, given, initial=stored)

    def valid_form(self, row: Any | None, sent: Mapping[str, Any]) -> Any:
        form: NounForm = self.form_of(row, sent)
        if not form.is_valid():
            raise refusal_of_form(form)
        if row is None and (said := form.repeated):
            problem = {"field": form.key, "message": said}
            raise Refusal(said, "is_there_already", HTTPStatus.CONFLICT, [problem])
        return form


class NounViewSet(NounRoute, RowsViewSet):
    """Rows that annotators add, change and delete; the history of a row keeps what it was.

    ``new_serializer`` reads a new row and ``change_serializer`` what may be changed of one.
    """

    new_serializer: type[BaseSerializer[Any]]
    change_serializer: type[BaseSerializer[Any]]
    duties = dict.fromkeys(("create", "partial_update", "destroy"), Duty.ANNOTATE)
    conditional = ("partial_update", "destroy")

    @once
    def create(self, request: ApiRequest, **kwargs: Any) -> Response:
        """Adds one."""
        form = self.valid_form(None, self.read(self.new_serializer))
        problems = form.remarks
        row = form.store(request.user, slot_of(request))
        response = self._written(row, problems, HTTPStatus.CREATED)
        response["Location"] = request.build_absolute_uri(f"{request.path}{row.pk}/")
        return response

    def partial_update(self, request: ApiRequest, **kwargs: Any) -> Response:
        """Changes one."""
        row = self.matched()
        form = self.valid_form(row, self.read(self.change_serializer, partial=True))
        problems = form.remarks
        saved = change(row, form.values, request.user, row.version, again=False)
        return self._written(saved, problems)

    def destroy(self, request: ApiRequest, **kwargs: Any) -> Response:
        """Deletes one; its history can bring it back."""
        row = self.matched()
        DELETING.get(type(row), delete)(row, request.user, row.version)
        return Response(status=HTTPStatus.NO_CONTENT)

    def _written(self, row: Editable, remarks: Any, status: int = HTTPStatus.OK) -> Response:
        """Respond with the stored row and the checker's problems on it."""
        shown = {"problems": list(map(as_json, remarks)), **self.get_serializer(row).data}
        return Response(shown, status=status, headers={"ETag": etag_of(row, shown)})
