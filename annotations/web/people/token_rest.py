"""One's own tokens, and where one is logged in."""

from __future__ import annotations

from http import HTTPStatus
from typing import Any

from django.contrib.auth import logout
from django.db.models import QuerySet
from django.http import Http404
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import OpenApiParameter, extend_schema
from rest_framework import serializers
from rest_framework.exceptions import PermissionDenied
from rest_framework.mixins import ListModelMixin
from rest_framework.response import Response

from annotations.models import ApiToken, LogInSession, Scope, User
from annotations.people.accounts import end_session, sessions_of
from annotations.people.audit_log import note
from annotations.web.people.member_rest import UNCACHED
from annotations.web.people.token_forms import TokenForm
from annotations.web.rest.form_fields import FormFields
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.problem_details import refusal_of_form
from annotations.web.rest.routes import Retrieved, Route, SingleRow, SiteViewSet


class TokenSerializer(serializers.ModelSerializer[ApiToken]):
    """A token, without its secret. ``is_this`` is the one that the request came with."""

    is_this = serializers.SerializerMethodField()

    class Meta:
        model = ApiToken
        fields = ["id", "name", "scope", "created_at", "expires_at", "is_this"]

    def get_is_this(self, token: ApiToken) -> bool:
        return bool(self.context["request"].auth == token)


class IssuedToken(TokenSerializer):
    """``key`` is the secret. It is not shown again."""

    key = serializers.CharField(read_only=True)

    class Meta(TokenSerializer.Meta):
        fields = [*TokenSerializer.Meta.fields, "key"]


class NewToken(FormFields):
    """What a token is for, what it may be used for, and how many days. A token cannot make one with a wider
    scope or a longer life than its own."""

    class Meta:
        form = TokenForm
        fields = ("name", "scope", "days")
        begins = True


class TokenViewSet(ListModelMixin, Retrieved, SiteViewSet):
    """One's own tokens."""

    model = ApiToken
    serializer_class = TokenSerializer
    filter_backends = []
    conditional = ("destroy",)
    sorts = {"newest": "-pk"}

    def rows(self) -> QuerySet[ApiToken]:
        return self.request.user.api_tokens.all()

    def calling_token(self, scope: str) -> ApiToken | None:
        """Return the token of the request, if there is one. Raises PermissionDenied where ``scope`` is more."""
        token = self.request.auth
        if not isinstance(token, ApiToken):
            return None
        if not Scope(token.scope).includes(Scope(scope)):
            raise PermissionDenied(
                f"This token has the scope “{token.scope}”, and “{scope}” is more than that."
            )
        return token

    @extend_schema(request=NewToken, responses={201: IssuedToken})
    def create(self, request: ApiRequest) -> Response:
        """Makes a token."""
        sent = self.read(NewToken)
        by = self.calling_token(sent["scope"])
        form = TokenForm(request.user, sent)
        if not form.is_valid():
            raise refusal_of_form(form)
        row, key = ApiToken.issue(request.user, **form.cleaned_data, by=by)
        note(request, f"{row.name} ({row.scope})")
        shown = {**self.get_serializer(row).data, "key": key}
        return Response(shown, status=HTTPStatus.CREATED, headers=UNCACHED)

    def destroy(self, request: ApiRequest, **kwargs: object) -> Response:
        """Revokes a token."""
        with self.matching() as row:
            self.calling_token(row.scope)
            row.delete()
        note(request, row.name)
        return Response(status=HTTPStatus.NO_CONTENT)


class SessionSerializer(serializers.ModelSerializer[LogInSession]):
    """A browser in which one is logged in."""

    id = serializers.CharField(source="handle", read_only=True)
    expires_at = serializers.DateTimeField(source="expire_date")

    class Meta:
        model = LogInSession
        fields = ["id", "device", "begun_at", "expires_at"]


class SessionsSerializer(serializers.Serializer[Any]):
    """All of them, the newest first."""

    results = SessionSerializer(many=True)


class Sessions(Route):
    """Lists where one is logged in."""

    model = LogInSession
    filter_backends = []

    @extend_schema(operation_id="sessions_list", responses={200: SessionsSerializer})
    def get(self, request: ApiRequest) -> Response:
        rows = sessions_of(request.user)
        return Response({"results": SessionSerializer(rows, many=True).data})


class OneSession(SingleRow):
    """Shows a browser in which one is logged in, and logs oneself out there."""

    model = LogInSession
    serializer_class = SessionSerializer
    conditional = ("DELETE",)
    scopes = {"DELETE": Scope.ADMIN}
    HANDLE = OpenApiParameter("handle", OpenApiTypes.STR, OpenApiParameter.PATH)

    def get_object(self) -> LogInSession:
        asked = self.kwargs["handle"]
        row = next((each for each in sessions_of(self.request.user) if each.handle == asked), None)
        if row is None:
            raise Http404("You are not logged in there.")
        return row

    def hold(self) -> None:
        """Hold all log-ins of the caller: an address names one of them by a hash."""
        User.objects.select_for_update(no_key=True).get(pk=self.request.user.pk)

    @extend_schema(parameters=[HANDLE])
    def get(self, request: ApiRequest, **kwargs: object) -> Response:
        return super().get(request)

    @extend_schema(parameters=[HANDLE])
    def delete(self, request: ApiRequest, **kwargs: object) -> Response:
        with self.matching() as row:
            end_session(request.user, row.handle)
        return Response(status=HTTPStatus.NO_CONTENT)


class EndSessions(Route):
    """Logs oneself out everywhere. Tokens stay."""

    http_method_names = ["post", "options"]
    model = LogInSession
    scopes = {"POST": Scope.ADMIN}

    @extend_schema(request=None, responses={204: None})
    def post(self, request: ApiRequest) -> Response:
        LogInSession.objects.filter(user=request.user).delete()
        if request.auth is None:
            logout(request._request)
        return Response(status=HTTPStatus.NO_CONTENT)
