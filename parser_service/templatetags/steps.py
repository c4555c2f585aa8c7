"""Template filter: what the references in a step of a plan stand for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from django import template

register = template.Library()


@register.filter
def referents(step: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Return each word of a step that stands for something said before, such as ``it``, with what that is."""
    pairs = (pair for value in step["arguments"].values() for pair in _references(value))
    return list(dict.fromkeys(pairs))


def _references(value: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    if "said" in value:
        yield value["said"], value["text"]
        return  # what is inside has been said before, in a step of its own
    if "of" in value:
        yield from _references(value["of"])
    for condition in value.get("conditions", ()):
        for each in condition["values"]:
            yield from _references(each)
