"""Who is in a world with which roles, and the links by which people join it."""

from __future__ import annotations

from http import HTTPStatus
from typing import Any

from django.db.models import Prefetch, QuerySet
from django.urls import reverse
from drf_spectacular.utils import extend_schema, extend_schema_field
from rest_framework import serializers
from rest_framework.exceptions import NotFound
from rest_framework.response import Response

from annotations.language.texts import Refusal
from annotations.models import Duty, Invitation, Membership, Scope, User
from annotations.models.worlds import Role, role_choices
from annotations.people.audit_log import note
from annotations.people.invitations import join
from annotations.people.members import add_roles, role_names, set_roles
from annotations.people.rate_limits import JOINING
from annotations.web.people.member_forms import OVER, TOO_OFTEN, InvitationForm, MemberForm
from annotations.web.rest.fields import Fields, LineField
from annotations.web.rest.form_fields import FormFields
from annotations.web.rest.idempotency import once
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.problem_details import refusal_of_form
from annotations.web.rest.routes import Route, RowsViewSet

UNCACHED = {"Cache-Control": "no-store"}  # of answers with a secret


def roles_field(**options: Any) -> serializers.ListField:
    return serializers.ListField(child=serializers.ChoiceField(choices=role_choices()), **options)


class MemberSerializer(serializers.ModelSerializer[User]):
    """An account, and all its roles in the world."""

    name = serializers.CharField(source="username")
    roles = serializers.SerializerMethodField()

    class Meta:
        model = User
        fields = ["id", "name", "roles"]

    @extend_schema_field(roles_field())
    def get_roles(self, user: Any) -> list[str]:
        held = {each.role for each in user.roles_here}
        return [role for role in Role.values if role in held]


class RolesChange(Fields):
    """All the roles that somebody has from now on."""

    roles = roles_field(min_length=1)


class NewMember(RolesChange):
    """The name of an existing account. People without one are invited."""

    name = LineField(max_length=150)


class MemberViewSet(RowsViewSet):
    """The members of a world."""

    model = User
    serializer_class = MemberSerializer
    filter_backends = []
    duties = dict.fromkeys(("create", "partial_update", "destroy"), Duty.MANAGE)
    conditional = ("partial_update", "destroy")
    sorts = {"name": "username", "id": "pk"}

    def rows(self) -> QuerySet[User]:
        here = Membership.objects.filter(world=self.world)
        rows = User.objects.filter(pk__in=here.values("user"))
        return rows.prefetch_related(Prefetch("memberships", here, "roles_here"))

    @extend_schema(request=NewMember, responses={201: MemberSerializer})
    @once
    def create(self, request: ApiRequest, **kwargs: object) -> Response:
        """Gives somebody with an account roles in the world."""
        form = MemberForm(self.read(NewMember))
        if not form.is_valid():
            raise refusal_of_form(form)
        account, roles = form.cleaned_data["name"], form.cleaned_data["roles"]
        if not add_roles(self.world, account, roles):
            said = f"{account} is {role_names(roles)} here already."
            raise Refusal(said, "has_roles_already", HTTPStatus.CONFLICT)
        note(request, f"{account}: {role_names(roles)}")
        return self.show(self.rows().get(pk=account.pk), HTTPStatus.CREATED)

    def hold(self) -> None:
        """Hold all roles of the world."""
        self.hold_world()

    @extend_schema(request=RolesChange, responses={200: MemberSerializer})
    def partial_update(self, request: ApiRequest, **kwargs: object) -> Response:
        """Changes the roles of a member."""
        with self.matching() as row:
            self._set_roles(row, self.read(RolesChange)["roles"])
        return self.show(self.get_object())

    def destroy(self, request: ApiRequest, **kwargs: object) -> Response:
        """Removes a member."""
        with self.matching() as row:
            self._set_roles(row, [])
        return Response(status=HTTPStatus.NO_CONTENT)

    def _set_roles(self, row: User, roles: list[str]) -> None:
        """Give the member just these roles. Raises NoAdminLeft."""
        set_roles(self.world, row, roles, by=self.request.user)
        note(self.request, f"{row}: {role_names(roles) or 'removed'}")


class InvitationSerializer(serializers.ModelSerializer[Invitation]):
    """A link that gives ``roles`` to as many people as it has ``places``, until it expires."""

    roles = roles_field()
    created_by = serializers.CharField(source="created_by.username")

    class Meta:
        model = Invitation
        fields = [
            *("id", "note", "roles", "places", "joined"),
            *("created_by", "created_at", "expires_at"),
        ]


class IssuedInvitation(InvitationSerializer):
    """``link`` is a page for people, ``key`` what ``join/`` takes. Neither is shown again."""

    link = serializers.CharField(read_only=True)
    key = serializers.CharField(read_only=True)

    class Meta(InvitationSerializer.Meta):
        fields = [*InvitationSerializer.Meta.fields, "link", "key"]


class NewInvitation(FormFields):
    """What a link gives, to how many people, and for how many days. ``note`` is for the admins."""

    roles = roles_field(min_length=1)

    class Meta:
        form = InvitationForm
        fields = ("places", "days", "note")
        begins = True


class InvitationViewSet(RowsViewSet):
    """The invitations that somebody can still join by."""

    model = Invitation
    serializer_class = InvitationSerializer
    filter_backends = []
    duties = dict.fromkeys(("list", "retrieve", "create", "destroy"), Duty.MANAGE)
    scopes = dict.fromkeys(("list", "retrieve"), Scope.READ)
    conditional = ("destroy",)
    sorts = {"newest": "-pk"}

    def rows(self) -> QuerySet[Invitation]:
        return self.world.invitations.open().select_related("created_by")

    @extend_schema(request=NewInvitation, responses={201: IssuedInvitation})
    def create(self, request: ApiRequest, **kwargs: object) -> Response:
        """Makes an invitation."""
        sent = self.read(NewInvitation)
        form = InvitationForm(
            {f"{InvitationForm.prefix}-{name}": each for name, each in sent.items()}
        )
        if not form.is_valid():
            raise refusal_of_form(form)
        row, key = Invitation.issue(self.world, by=request.user, **form.cleaned_data)
        note(request, f"{role_names(row.roles)}: {row.note or 'a link'}")
        link = request.build_absolute_uri(reverse("join", kwargs={"key": key}))
        shown = {**InvitationSerializer(row).data, "link": link, "key": key}
        return Response(shown, status=HTTPStatus.CREATED, headers=UNCACHED)

    def destroy(self, request: ApiRequest, **kwargs: object) -> Response:
        """Withdraws an invitation: who has joined by it stays."""
        with self.matching() as row:
            Invitation.objects.filter(pk=row.pk).withdraw()
        note(request, row.note or "a link")
        return Response(status=HTTPStatus.NO_CONTENT)


class KeyOfInvitation(Fields):
    """The ``key`` of an invitation, which is the last part of its link."""

    key = serializers.CharField(max_length=200)


class JoinedSerializer(serializers.Serializer[Any]):
    """The world that the caller is in now, and the roles that the invitation gave."""

    world = serializers.CharField()
    roles = roles_field()


class Join(Route):
    """Lets the caller join a world by an invitation. Wrong keys are counted by address."""

    http_method_names = ["post", "options"]
    model = Invitation
    scopes = {"POST": Scope.ADMIN}

    @extend_schema(request=KeyOfInvitation, responses={200: JoinedSerializer})
    def post(self, request: ApiRequest) -> Response:
        key = self.read(KeyOfInvitation)["key"]
        place = JOINING.take(str(request.META["REMOTE_ADDR"]))
        if place is None:
            raise Refusal(TOO_OFTEN, "too_often", HTTPStatus.TOO_MANY_REQUESTS)
        invitation = Invitation.objects.for_key(key)
        if invitation is None:
            raise NotFound(OVER)
        join(invitation, request.user)
        JOINING.give_back(place)
        note(request, f"{invitation.world} as {role_names(invitation.roles)}")
        return Response({"world": invitation.world.name, "roles": invitation.roles})
