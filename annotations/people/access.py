"""Who may open which page: every view names the duty that it needs, and this is the only check.

``@world_view(Duty.VIEW)`` stands above every view of a world. The view receives the world itself
instead of its name. People outside the world get a 404, as if it did not exist; members without the
duty get a 403 with a sentence. A view that is posted to also says what it does, for the audit log.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any, TypeVar

from django.core.exceptions import ImproperlyConfigured, PermissionDenied
from django.http import Http404, HttpRequest
from django.http.response import HttpResponseBase
from django.views.decorators.http import require_http_methods
from django_htmx.middleware import HtmxDetails

from annotations.models import Duty, User, World

View = Callable[..., HttpResponseBase]
AnyView = TypeVar("AnyView", bound=View)


class PageRequest(HttpRequest):
    """For signatures: the request of somebody who is logged in, as middleware hands it on."""

    user: User
    htmx: HtmxDetails


class WorldRequest(PageRequest):
    """For signatures: a request into a world, as ``world_view`` hands it on."""

    world: World
    duties: frozenset[Duty]


READ = ("GET", "HEAD")
READ_AND_WRITE = ("GET", "HEAD", "POST")
WRITE = ("POST",)
NOTHING = "nothing"  # that others see: the audit log does not record it

WHO_MAY = {
    Duty.VIEW: "members of this world",
    Duty.ANNOTATE: "annotators and admins of this world",
    Duty.REVIEW: "reviewers and admins of this world",
    Duty.MANAGE: "admins of this world",
}


def plain_view(methods: tuple[str, ...] = READ, does: str = "") -> Callable[[AnyView], AnyView]:
    """Return a view that asks for no duty: of what is everybody's, or one's own.

    ``does`` are the words of the audit log for a POST, or ``NOTHING``.
    """
    if ("POST" in methods) != bool(does):
        raise ImproperlyConfigured(
            "A view that is posted to says what it does, and no other view does."
        )

    def decorate(view: AnyView) -> AnyView:
        guarded = require_http_methods(methods)(view)
        guarded.does = does  # type: ignore[attr-defined]  # of a function
        return guarded

    return decorate


def world_view(
    duty: Duty,
    methods: tuple[str, ...] = READ,
    write_duty: Duty | None = None,
    does: str = "",
) -> Callable[[View], View]:
    """Return a view at ``/w/<world>/…`` for people with ``duty``; a POST needs ``write_duty`` where given.

    Sets ``request.world`` and ``request.duties`` (what the person may do here) for the templates. ``does`` is that of
    ``plain_view``.
    """

    def decorate(view: View) -> View:
        @wraps(view)
        def guarded(request: WorldRequest, world: str, **kwargs: Any) -> HttpResponseBase:
            request.world, request.duties = world_of(request, world)
            demand(request, write_duty if write_duty and request.method == "POST" else duty)
            return view(request, request.world, **kwargs)

        guarded.duties = {"GET": duty, "POST": write_duty or duty}  # type: ignore[attr-defined]  # of a function
        return plain_view(methods, does)(guarded)

    return decorate


def site_view(methods: tuple[str, ...] = READ, does: str = "") -> Callable[[View], View]:
    """Return a view outside of any world, for the administrators of the site; ``does`` is that of ``plain_view``."""

    def decorate(view: View) -> View:
        @wraps(view)
        def guarded(request: HttpRequest, **kwargs: Any) -> HttpResponseBase:
            demand_site_admin(request)
            return view(request, **kwargs)

        return plain_view(methods, does)(guarded)

    return decorate


def world_of(request: HttpRequest, name: str) -> tuple[World, frozenset[Duty]]:
    """Return the world called ``name`` and what the person may do in it.

    Raises Http404 for people who are not members of it.
    """
    seen = World.objects.seen_by(request.user, name) if request.user.is_authenticated else None
    if seen is None:
        raise Http404("There is no such world.")
    return seen


def demand_site_admin(request: HttpRequest) -> None:
    """Raise PermissionDenied for everybody but the administrators of the site."""
    if not request.user.is_superuser:
        raise PermissionDenied("Only administrators of this installation may do this.")


def demand(request: WorldRequest, duty: Duty) -> None:
    """Raise PermissionDenied with a sentence for people without ``duty`` in the world."""
    if not request.duties:
        raise Http404("No such world.")
    if duty not in request.duties:
        raise PermissionDenied(f"Only {WHO_MAY[duty]} may do this.")
