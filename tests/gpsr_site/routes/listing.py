"""Every route of the site."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from django.urls import URLPattern, URLResolver, get_resolver


def list_routes(patterns, namespace: str = "", path: str = "") -> Iterator[tuple[str, str]]:
    """Yield name and path of every route; what Django's own admin adds counts as ``admin:index``."""
    for pattern in patterns:
        here = path + str(pattern.pattern)
        if isinstance(pattern, URLResolver):
            inside = f"{pattern.namespace}:" if pattern.namespace else namespace
            if pattern.namespace == "admin":
                yield "admin:index", here
            else:
                yield from list_routes(pattern.url_patterns, inside, here)
        elif isinstance(pattern, URLPattern):
            yield f"{namespace}{pattern.name}", here


@dataclass(frozen=True)
class ApiRoute:
    """A route of the API: its class, and of a view set which action answers which method."""

    view: type
    actions: dict[str, str]

    @property
    def methods(self) -> set[str]:
        """The methods that it answers, in small letters, HEAD left out."""
        answered = [each for each in self.view.http_method_names if hasattr(self.view, each)]
        return set(self.actions or answered) - {"head", "options"}

    def asked(self, method: str) -> str:
        """Return what ``duties``, ``scopes`` and ``conditional`` call a method."""
        return self.actions.get(method.lower(), method.upper())


def list_views(patterns, namespace: str = "") -> Iterator[tuple[str, Any]]:
    """Yield name and view of every route but those of Django's admin."""
    for pattern in patterns:
        if isinstance(pattern, URLResolver):
            inside = f"{pattern.namespace}:" if pattern.namespace else namespace
            if pattern.namespace != "admin":
                yield from list_views(pattern.url_patterns, inside)
        elif isinstance(pattern, URLPattern):
            yield f"{namespace}{pattern.name}", pattern.callback


ALL_ROUTES = dict(list_routes(get_resolver().url_patterns))
VIEWS = dict(list_views(get_resolver().url_patterns))
API_ROUTES = {
    name: ApiRoute(view.cls, getattr(view, "actions", {}))
    for name, view in VIEWS.items()
    if name.startswith("api:")
}
ROUTES_OF_WORLDS = {name for name, path in ALL_ROUTES.items() if "<slug:world>" in path}
ROUTES_OF_ROWS = sorted(name for name in ROUTES_OF_WORLDS if "<int:" in ALL_ROUTES[name])
