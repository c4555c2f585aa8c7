"""All accounts of the site, and the audit log, for those who look after them."""

from __future__ import annotations

from typing import Any

from django.db.models import QuerySet
from django.shortcuts import get_object_or_404
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.decorators import action
from rest_framework.mixins import ListModelMixin
from rest_framework.response import Response

from annotations.models import AuditEntry, Duty, Membership, Scope, User
from annotations.people.accounts import password_path, set_open
from annotations.people.audit_log import note
from annotations.web.people.member_rest import UNCACHED
from annotations.web.people.people_filters import AccountFilters, AuditEntryFilters
from annotations.web.rest.fields import Fields
from annotations.web.rest.permissions import ApiRequest, ForSiteAdmins
from annotations.web.rest.routes import ManyRows, Retrieved, RowsRoute, SiteViewSet


class RoleInWorld(serializers.ModelSerializer[Membership]):
    world = serializers.CharField(source="world.name")

    class Meta:
        model = Membership
        fields = ["world", "role"]


class AccountSerializer(serializers.ModelSerializer[User]):
    """An account with its roles in all worlds. Nobody logs in to one that is not active."""

    name = serializers.CharField(source="username")
    roles = RoleInWorld(source="memberships", many=True)

    class Meta:
        model = User
        fields = ["id", "name", "is_active", "is_superuser", "date_joined", "roles"]


class AccountChange(Fields):
    """Closing an account logs it out everywhere and stops its tokens."""

    is_active = serializers.BooleanField()


class PasswordLink(serializers.Serializer[Any]):
    """Whoever opens the page sets a new password, once, within three days."""

    link = serializers.CharField()


class AccountViewSet(ListModelMixin, Retrieved, SiteViewSet):
    """All accounts. People join by invitations; ``manage.py`` makes the first one."""

    model = User
    serializer_class = AccountSerializer
    filterset_class = AccountFilters
    permission_classes = [ForSiteAdmins]
    duty = Duty.MANAGE
    scopes = dict.fromkeys(("list", "retrieve"), Scope.READ)
    conditional = ("partial_update",)
    sorts = {"name": "username", "joined": "date_joined"}

    def rows(self) -> QuerySet[User]:
        return User.objects.prefetch_related("memberships__world")

    @extend_schema(request=AccountChange, responses={200: AccountSerializer})
    def partial_update(self, request: ApiRequest, **kwargs: object) -> Response:
        """Closes an account, or opens it."""
        is_open = self.read(AccountChange)["is_active"]
        with self.matching() as row:
            set_open(row, is_open, by=request.user)
        note(request, f"{row}: {'open' if is_open else 'closed'}")
        return self.show(self.get_object())

    @extend_schema(request=None, responses={200: PasswordLink})
    @action(detail=True, methods=["post"])
    def link(self, request: ApiRequest, **kwargs: object) -> Response:
        """Makes a link for somebody who has lost their password."""
        row = get_object_or_404(self.rows().filter(is_active=True), pk=self.kwargs["pk"])
        note(request, str(row))
        link = request.build_absolute_uri(password_path(row))
        return Response({"link": link}, headers=UNCACHED)


class AuditEntrySerializer(serializers.ModelSerializer[AuditEntry]):
    """What somebody did, and to what; ``through`` names the token of a program. It outlives both."""

    who = serializers.CharField(source="who_name")
    world = serializers.CharField(source="world_name")

    class Meta:
        model = AuditEntry
        fields = ["id", "at", "who", "through", "what", "subject", "world"]


class AuditEntryRows(ManyRows):
    model = AuditEntry
    serializer_class = AuditEntrySerializer
    filterset_class = AuditEntryFilters
    sorts = {"newest": "-pk"}


class AuditLogOfWorld(AuditEntryRows, RowsRoute):
    """Lists who did what in a world, the newest first."""

    duties = {"GET": Duty.MANAGE}
    scopes = {"GET": Scope.READ}

    def rows(self) -> QuerySet[AuditEntry]:
        return AuditEntry.objects.filter(world=self.world)


class SiteLog(AuditEntryRows):
    """Lists who did what anywhere, the newest first."""

    permission_classes = [ForSiteAdmins]
    duty = Duty.MANAGE
    scopes = {"GET": Scope.READ}

    def rows(self) -> QuerySet[AuditEntry]:
        return AuditEntry.objects.all()
