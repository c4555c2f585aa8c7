"""Every route of the site."""

from __future__ import annotations

from collections.abc import Iterator

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


def list_views(patterns, namespace: str = "") -> Iterator[tuple[str, type]]:
    """Yield name and class of every route of the API."""
    for pattern in patterns:
        if isinstance(pattern, URLResolver):
            inside = f"{pattern.namespace}:" if pattern.namespace else namespace
            yield from list_views(pattern.url_patterns, inside)
        elif isinstance(pattern, URLPattern) and namespace == "api:":
            yield f"{namespace}{pattern.name}", pattern.callback.view_class


ALL_ROUTES = dict(list_routes(get_resolver().url_patterns))
API_VIEWS = dict(list_views(get_resolver().url_patterns))
ROUTES_OF_WORLDS = {name for name, path in ALL_ROUTES.items() if "<slug:world>" in path}
ROUTES_OF_ROWS = sorted(name for name in ROUTES_OF_WORLDS if "<int:" in ALL_ROUTES[name])
