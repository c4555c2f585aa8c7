"""Who calls the API: the owner of the token in ``Authorization: Bearer …``."""

from __future__ import annotations

from typing import cast

from django.http import HttpRequest
from drf_spectacular.extensions import OpenApiAuthenticationExtension
from rest_framework.authentication import BaseAuthentication, get_authorization_header
from rest_framework.exceptions import AuthenticationFailed
from rest_framework.request import Request

from annotations.models import ApiToken, User


class TokenAuthentication(BaseAuthentication):
    """Reads ``Authorization: Bearer <token>``. A token that is wrong or has expired is a 401."""

    keyword = "Bearer"

    def authenticate(self, request: Request | HttpRequest) -> tuple[User, ApiToken] | None:
        words = get_authorization_header(cast(Request, request)).split()
        if not words or words[0].lower() != self.keyword.lower().encode():
            return None
        if len(words) != 2:
            raise AuthenticationFailed("Write the header as “Authorization: Bearer <token>”.")
        token = ApiToken.objects.for_key(words[1].decode("latin-1"))
        if token is None:
            raise AuthenticationFailed("This token is not known here, or it has expired.")
        return token.user, token

    def authenticate_header(self, request: Request) -> str:
        return self.keyword


class TokenScheme(OpenApiAuthenticationExtension):  # type: ignore[no-untyped-call]
    """How the OpenAPI schema describes the token."""

    target_class = "annotations.web.rest.authentication.TokenAuthentication"
    name = "token"

    def get_security_definition(self, auto_schema: object) -> dict[str, str]:
        return {"type": "http", "scheme": "bearer"}
