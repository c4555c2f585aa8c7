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
    """Checks ``World.allows(user, view.duty)`` for the world in the URL, and sets ``view.world``.

    A world that the caller is not a member of is a 404, as if it did not exist. A duty that their
    role does not include is a 403. A caller without a valid token gets a 401.
    """

    message = "Your role in this world does not allow this."

    def has_permission(self, request: Request, view: APIView) -> bool:
        if not request.user.is_authenticated:
            return False
        world = World.objects.visible_to(request.user).filter(name=view.kwargs["world"]).first()
        if world is None:
            raise Http404("There is no such world.")
        view.world = world
        duty: Duty = view.duty
        return world.allows(request.user, duty)
