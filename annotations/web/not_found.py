"""What an answer 404 says: what is not there, and where to look for what is."""

from __future__ import annotations

import re

from django.apps import apps
from django.urls import Resolver404, resolve

# The sentence of get_object_or_404 and of DRF, which speaks of queries.
_OF_DJANGO = re.compile(r"No (?P<model>\w+) matches the given query\.")
# What people call models whose own name is another.
_WORDS = {"user": "account", "semantic template": "template", "training run": "run"}


def say_missing(error: Exception, path: str) -> str:
    """Return the sentence for ``error``, a 404 for the address ``path``."""
    said = str(error.args[0]) if error.args and isinstance(error.args[0], str) else ""
    match = _OF_DJANGO.fullmatch(said)
    if match is None:
        return said or f"There is nothing at {path[:200]}."
    model = match["model"]
    names = {each.__name__: str(each._meta.verbose_name) for each in apps.get_models()}
    name = names.get(model, model.lower())
    keys = _keys_in(path)
    key = keys.get(model.lower(), keys.get("pk", keys.get("key", "")))
    number = f" {str(key)[:40]}" if key != "" else ""
    return f"There is no {_WORDS.get(name, name)}{number} that you can see here."


def where_to_look(error: Exception, path: str) -> str:
    """Return the nearest address above ``path`` that shows something; empty where there is none."""
    is_world = bool(error.args) and "such world" in str(error.args[0])
    parts = path.strip("/").split("/")
    if is_world:
        return "/api/v1/worlds/" if parts[0] == "api" else "/"
    keys = {str(key) for name, key in _keys_in(path).items() if name != "world"}
    for length in range(len(parts) - 1, 0, -1):
        above = f"/{'/'.join(parts[:length])}/"
        if keys & set(parts[:length]) or parts[length - 1].isdigit():
            continue  # below what is missing
        try:
            found = resolve(above)
        except Resolver404:
            continue
        view = getattr(found.func, "view_class", None)
        actions = getattr(found.func, "actions", None)  # of a view set
        if "get" in actions if actions else view is None or hasattr(view, "get"):
            return above
    return "/api/v1/schema/" if parts[0] == "api" else ""


def _keys_in(path: str) -> dict[str, object]:
    try:
        return dict(resolve(path).kwargs)
    except Resolver404:
        return {}
