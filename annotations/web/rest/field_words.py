"""Describes what the schema names and no help text describes: one name stands for one thing in the whole API."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any


def describe_fields(result: dict[str, Any], **_: object) -> dict[str, Any]:
    """Return the schema with the words of ``field_words.toml`` for each field and parameter that has none."""
    for name, described in _named(result):
        field = name.rpartition(".")[2]
        words = _words().get(name) or _words().get(field)
        if words and not described.get("description"):
            described["description"] = words
    return result


def _named(result: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the fields as ``Component.field``, and the parameters by their name."""
    for component, schema in result["components"]["schemas"].items():
        for field, described in schema.get("properties", {}).items():
            yield f"{component}.{field}", described
    for methods in result["paths"].values():
        for operation in methods.values():
            for parameter in operation.get("parameters", ()):
                yield parameter["name"], parameter


@cache
def _words() -> dict[str, str]:
    path = Path(__file__).with_suffix(".toml")
    words: dict[str, str] = tomllib.loads(path.read_text(encoding="utf-8"))
    return words
