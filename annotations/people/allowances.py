"""What a view may ask of the server beyond the usual: files, and time.

A view says so itself, with ``@takes_files`` or ``@may_take_long``. The web server and the middleware
look it up by the address of a request, before they read any of its body.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeVar

from django.urls import Resolver404, resolve

from annotations.models import Duty, Scope

View = TypeVar("View", bound=Any)


def takes_files(view: View) -> View:
    """Declare that a view, the class of a route, or an action of a view set, reads files that people send.
    Reading may take long."""
    view.takes_files = True
    return may_take_long(view)


def may_take_long(view: View) -> View:
    """Declare that a view, the class of a route, or an action of a view set, makes or packs many rows."""
    view.may_take_long = True
    return view


def only_reads(view: View) -> View:
    """Declare that a POST to a view stores nothing, so that it waits for no writer."""
    view.only_reads = True
    return view


@dataclass(frozen=True)
class Allowance:
    """What the view at an address takes.

    Files come from people with ``duty`` in the world called ``world``; outside of any world, from the
    administrators of the site. ``only_reads`` says that a POST stores nothing.
    """

    takes_files: bool = False
    may_take_long: bool = False
    only_reads: bool = False
    world: str | None = None
    duty: Duty | None = None


USUAL = Allowance()


def with_last_slash(path: str) -> str:
    """Return the path of a page as it is, and one of the API as its addresses are written: with a slash at the end."""
    return f"{path}/" if path.startswith("/api/") and not path.endswith("/") else path


def allowance_at(path: str) -> Allowance:
    """Return what the view at ``path`` takes; the usual where there is none."""
    try:
        match = resolve(with_last_slash(path))
    except Resolver404:
        return USUAL
    view: Any = getattr(match.func, "cls", match.func)
    actions: dict[str, str] = getattr(match.func, "actions", {})  # of a view set, by method
    declaring = [view, *(getattr(view, name) for name in actions.values())]
    post = actions.get("post", "POST")
    return Allowance(
        takes_files=any(getattr(each, "takes_files", False) for each in declaring),
        may_take_long=any(getattr(each, "may_take_long", False) for each in declaring),
        only_reads=getattr(view, "only_reads", False)
        or getattr(view, "scopes", {}).get(post) == Scope.READ,
        world=match.kwargs.get("world"),
        duty=getattr(view, "duties", {}).get(post),
    )
