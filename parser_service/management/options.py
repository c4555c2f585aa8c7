"""What options on a command line mean: train sources and hyperparameters."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from parser_service.models.runs import TrainSources
from parser_service.parsers.registry import config_fields

TRUTHS = {"true": True, "yes": True, "1": True, "false": False, "no": False, "0": False}


def read_sources(text: str) -> str:
    """``gen,para`` in either order and with either sign as ``gen+para``. Raises ValueError."""
    named = set(text.replace(",", "+").split("+"))
    for sources in TrainSources.values:
        if named == set(sources.split("+")):
            return str(sources)
    raise ValueError(f"--sources is {text!r}; it has to be gen, para or gen,para.")


def read_hyperparameters(parser: str, assignments: Sequence[str]) -> dict[str, Any]:
    """``KEY=VALUE`` texts as values of the types that the parser declares. Raises ValueError."""
    types = {declared.name: declared.type for declared in config_fields(parser)}
    values = {}
    for assignment in assignments:
        name, is_assigned, text = assignment.partition("=")
        if not is_assigned:
            raise ValueError(f"--config {assignment!r} has to be KEY=VALUE.")
        # An unknown name is refused with the known ones when the config is made.
        values[name] = _read(name, text, types.get(name, str))
    return values


def _read(name: str, text: str, kind: type) -> Any:
    try:
        return TRUTHS[text.lower()] if kind is bool else kind(text)
    except (KeyError, ValueError):
        raise ValueError(f"--config {name}={text} has to be of type {kind.__name__}.") from None
