"""Decides who may do what over the API. A route that names no duty is closed to everybody."""

from __future__ import annotations

from typing import TYPE_CHECKING

from django.http import Http404
from rest_framework.permissions import BasePermission
from rest_framework.request import Request

from annotations.models import Duty, World

if TYPE_CHECKING:  # rest_framework.views imports the default permission, which stands here
    from rest_framework.views import APIView


class DenyByDefault(BasePermission):
    """The default of every route: nothing is allowed until a route says what it is for."""

    message = "This route does not say who may use it, so nobody may."

    def has_permission(self, request: Request, view: APIView) -> bool:
        return False


class HasDuty(BasePermission):
    """Checks that the caller has ``view.duty`` in the world of the URL, and sets ``view.world``.

    A world that the caller is not a member of is a 404, as if it did not exist. A duty that their
    role does not include is a 403. A caller without a valid token gets a 401.
    """

    message = "Your role in this world does not allow this."

    def has_permission(self, request: Request, view: APIView) -> bool:
        if not request.user.is_authenticated:
            return False
        seen = World.objects.seen_by(request.user, view.kwargs["world"])
        if seen is None:
            raise Http404("There is no such world.")
        view.world, duties = seen
        duty: Duty = view.duty
        return duty in duties
