"""Decides who may do what over the API. A route that names no duty is closed to everybody."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from django.http import Http404
from rest_framework.exceptions import PermissionDenied
from rest_framework.permissions import SAFE_METHODS, BasePermission
from rest_framework.request import Request

from annotations.models import ApiToken, Duty, Scope, User, World

if TYPE_CHECKING:  # rest_framework.views imports the default permission, which stands here
    from rest_framework.views import APIView


class ApiRequest(Request):
    """For signatures: a request of somebody who has named themselves. ``world`` is that of a route below one."""

    user: User
    auth: ApiToken | None
    world: World


class DenyByDefault(BasePermission):
    """The default of every route: nothing is allowed until a route says what it is for."""

    message = "This route does not say who may use it, so nobody may."

    def has_permission(self, request: Request, view: APIView) -> bool:
        return False


# The scope that a token needs for a duty. The one place for this rule.
SCOPE_FOR = {
    Duty.VIEW: Scope.READ,
    Duty.ANNOTATE: Scope.ANNOTATE,
    Duty.REVIEW: Scope.ANNOTATE,
    Duty.MANAGE: Scope.ADMIN,
}


def asked_of(view: APIView, method: str) -> str:
    """Return the key of a request in ``duties``, ``scopes``, ``conditional`` and ``unrecorded`` of a view: the
    action in a view set, else the method."""
    return getattr(view, "action", None) or ("GET" if method == "HEAD" else method)


def scope_needed(view: APIView, method: str) -> Scope:
    """Return the scope that a token needs for ``method`` of ``view``.

    It follows from duty and method unless ``view.scopes`` names another: ``Scope.READ`` for a POST that
    stores nothing and for what only admins read, ``Scope.TRAIN`` for a POST that starts a run.
    """
    named: Scope | None = getattr(view, "scopes", {}).get(asked_of(view, method))
    if named is not None:
        return named
    for_duty = SCOPE_FOR[getattr(view, "duty", Duty.VIEW)]
    stores = method not in SAFE_METHODS and for_duty == Scope.READ
    return Scope.ANNOTATE if stores else for_duty


class HasScope(BasePermission):
    """Checks that somebody calls, and that a token allows the method. For routes outside of worlds.

    A caller without a valid token gets a 401; a token of too narrow a scope is a 403. Somebody who is
    logged in on the pages needs no token.
    """

    def has_permission(self, request: Request, view: APIView) -> bool:
        if not request.user.is_authenticated:
            return False
        token, needed = request.auth, scope_needed(view, request.method or "")
        if isinstance(token, ApiToken) and not Scope(token.scope).includes(needed):
            raise PermissionDenied(
                f"This token has the scope “{token.scope}”, and this needs “{needed}”. "
                "Make another token on the page of your account."
            )
        return True


class HasDuty(HasScope):
    """Checks that the caller has ``view.duty`` in the world of the URL, and sets ``view.world``.

    A world that the caller is not a member of is a 404, as if it did not exist. A duty that their
    role does not include is a 403, and so is a token whose scope does not include it.
    """

    message = "Your role in this world does not allow this."

    def has_permission(self, request: Request, view: Any) -> bool:
        if not request.user.is_authenticated:
            return False
        seen = World.objects.seen_by(request.user, view.kwargs["world"])
        if seen is None:
            raise Http404("There is no such world.")
        view.world, duties = seen
        duty: Duty = view.duty
        return duty in duties and super().has_permission(request, view)


class ForSiteAdmins(HasScope):
    """Lets the administrators of the site in, with a token whose scope includes ``view.duty``."""

    message = "Only administrators of this installation may do this."

    def has_permission(self, request: Request, view: APIView) -> bool:
        return bool(request.user.is_superuser) and super().has_permission(request, view)


class ChangedBySiteAdmins(ForSiteAdmins):
    """Lets everybody read who has an account, and only administrators of the site change something."""

    def has_permission(self, request: Request, view: APIView) -> bool:
        if request.method in SAFE_METHODS:
            return HasScope.has_permission(self, request, view)
        return super().has_permission(request, view)
