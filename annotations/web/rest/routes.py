"""What routes of the API are made of: single addresses, and view sets of kinds of rows that people may edit.

The verbs behind writes are those of the pages: a form of theirs says what is wrong, and
``annotations.editing`` stores what is right, with its history and all that follows from it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from http import HTTPStatus
from typing import Any

from django.db import transaction
from django.db.models import Model, QuerySet
from django.http import Http404
from rest_framework.generics import GenericAPIView
from rest_framework.mixins import ListModelMixin
from rest_framework.request import Request
from rest_framework.response import Response
from rest_framework.serializers import BaseSerializer
from rest_framework.viewsets import ViewSetMixin

from annotations.models import Duty, World
from annotations.web.rest.matching import etag_of, require_match
from annotations.web.rest.pagination import Keyset
from annotations.web.rest.parsing import BoundedJSONParser
from annotations.web.rest.permissions import ApiRequest, HasDuty, HasScope, asked_of


class Route(GenericAPIView[Any]):
    """A route outside of any world. ``duties`` has the duty for each method, or for each action of a view
    set. It also decides the scope that a token needs. Reading needs ``Duty.VIEW``."""

    permission_classes = [HasScope]
    duties: Mapping[str, Duty] = {}
    parser_classes = [BoundedJSONParser]
    conditional: tuple[str, ...] = ()  # what needs If-Match
    unrecorded: tuple[str, ...] = ()  # what changes nothing that others see, for the audit log
    model: type[Model]
    request: ApiRequest

    @property
    def duty(self) -> Duty:
        """What the request needs."""
        return self.duties.get(asked_of(self, self.request.method or ""), Duty.VIEW)

    def rows(self) -> QuerySet[Any]:
        """Return the rows that the route is about, as far as the caller sees them."""
        raise NotImplementedError

    def get_queryset(self) -> QuerySet[Any]:
        is_described = getattr(self, "swagger_fake_view", False)
        return self.model._default_manager.none() if is_described else self.rows()

    def read(self, serializer: type[BaseSerializer[Any]], **options: Any) -> dict[str, Any]:
        """Read the body with ``serializer``. Raises ValidationError."""
        sent = serializer(data=self.request.data, **options)
        sent.is_valid(raise_exception=True)
        return dict(sent.validated_data)


class WorldRoute(Route):
    """A route below a world: ``duties`` are those of the caller there."""

    permission_classes = [HasDuty]
    world: World

    def initial(self, request: Request, *args: Any, **kwargs: Any) -> None:
        super().initial(request, *args, **kwargs)
        self.request.world = self.world  # filters look there for the choices of the world

    def hold_world(self) -> None:
        """Read and lock the world until the end of the transaction. Raises Http404 if it is gone."""
        held = World.objects.present().hold().filter(pk=self.world.pk).first()
        if held is None:
            raise Http404("There is no such world.")
        self.world = held


class Tagged(Route):
    """Shows a row with the tag of its version, and lets only those write to it who name that version."""

    def show(self, row: Any, status: int = HTTPStatus.OK) -> Response:
        shown = self.get_serializer(row).data
        return Response(shown, status=status, headers={"ETag": etag_of(row, shown)})

    def matched(self) -> Any:
        """Return the row, if it is at the version that the request names. Raises Overtaken otherwise.

        For verbs that take the version of the row and compare it again while they hold the row. Others
        write inside ``matching``.
        """
        row = self.get_object()
        require_match(self.request, row, self.get_serializer(row).data)
        return row

    @contextmanager
    def matching(self) -> Iterator[Any]:
        """Lock the row for the block that writes to it, if it is at the version that the request names.

        Raises Overtaken otherwise. The row is locked before it is compared, until the end of the block:
        of several writers who have read one version, only one writes.
        """
        with transaction.atomic():
            self.hold()
            yield self.matched()

    def hold(self) -> None:
        """Lock the row until the end of the transaction.

        If the row is made of several, or is not stored yet, the route locks what these belong to.
        """
        rows = self.model._default_manager.select_for_update(no_key=True)
        rows.filter(pk=self.kwargs["pk"]).first()


class ManyRows(ListModelMixin, Tagged):
    """A list, filtered, sorted and paged by its address."""

    pagination_class: type[Keyset] | None = Keyset
    sorts: Mapping[str, str] = {"id": "pk"}

    def get(self, request: ApiRequest, **kwargs: Any) -> Response:
        return self.list(request)


class SingleRow(Tagged):
    """One row, with the tag of its version."""

    filter_backends = []

    def get(self, request: ApiRequest, **kwargs: Any) -> Response:
        return self.show(self.get_object())


class RowsRoute(ManyRows, WorldRoute):
    """A list of rows of a world."""


class RowRoute(SingleRow, WorldRoute):
    """One row of a world."""


class SiteViewSet(ViewSetMixin, Tagged):
    """A kind of row: its list, each of its rows, and the actions on one.

    The keys of ``duties``, ``scopes``, ``conditional`` and ``unrecorded`` are its actions. An action without a
    docstring is described by that of the class.
    """

    lookup_value_converter = "int"
    pagination_class = Keyset
    sorts: Mapping[str, str] = {"id": "pk"}

    def filter_queryset(self, rows: QuerySet[Any]) -> QuerySet[Any]:
        """Filter only lists: a single row is found whatever filters the address has."""
        return rows if self.detail else super().filter_queryset(rows)


class WorldViewSet(SiteViewSet, WorldRoute):
    """A kind of row of a world."""


class Retrieved(Tagged):
    """The action that shows one row."""

    def retrieve(self, request: ApiRequest, **kwargs: Any) -> Response:
        return self.show(self.get_object())


class RowsViewSet(ListModelMixin, Retrieved, WorldViewSet):
    """A kind of row of a world that is listed, and shown one by one."""


class Figures(WorldRoute):
    """Figures of a whole world, worked out when they are asked for."""

    filter_backends = []
    pagination_class = None
