"""What options on a command line mean: names, columns, train sources and hyperparameters."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

from annotations.language.splitting import Criterion
from parser_service.benchmarking import SETTINGS, Column
from parser_service.models.runs import Protocol, TrainSources
from parser_service.parsers.registry import PARSERS, config_fields

TRUTHS = {"true": True, "yes": True, "1": True, "false": False, "no": False, "0": False}


def read_names(text: str | None, known: Sequence[str]) -> list[str]:
    """Names with commas between them; None is all. Raises ValueError where one is not ``known``."""
    names = list(known) if text is None else [name.strip() for name in text.split(",")]
    for name in names:
        if name not in known:
            raise ValueError(f"{name!r} is none of {', '.join(known)}.")
    return names


def read_column(text: str) -> Column:
    """``SETTING:CRITERION:PROTOCOL``. Raises ValueError where it is not that, or a part is unknown."""
    parts = text.split(":")
    known = (SETTINGS, list(Criterion), Protocol.values)
    if len(parts) != len(known):
        raise ValueError(
            f"--columns {text!r} has to be SETTING:CRITERION:PROTOCOL, for example "
            f"{SETTINGS[-1]}:{known[1][0]}:{known[2][0]}."
        )
    return Column(*(read_names(part, names)[0] for part, names in zip(parts, known, strict=True)))


def read_split_seeds(text: str) -> range:
    """``N`` as the seeds 0 to N - 1, ``A-B`` as those from A to B. Raises ValueError."""
    if found := re.fullmatch(r"(\d+)(?:-(\d+))?", text.strip()):
        first, last = found.groups()
        seeds = range(int(first)) if last is None else range(int(first), int(last) + 1)
        if seeds or last is None:
            return seeds
    raise ValueError(
        f"--new-splits is {text!r}; it has to be a number of splits (5), or the seeds of the first and "
        "the last (6-9)."
    )


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


def read_configurations(assignments: Sequence[str]) -> dict[str, dict[str, Any]]:
    """``PARSER.KEY=VALUE`` texts as hyperparameters by parser. Raises ValueError."""
    texts: dict[str, list[str]] = {}
    for assignment in assignments:
        parser, has_dot, rest = assignment.partition(".")
        if not has_dot or parser not in PARSERS:
            raise ValueError(f"--config {assignment!r} has to be PARSER.KEY=VALUE.")
        texts.setdefault(parser, []).append(rest)
    return {parser: read_hyperparameters(parser, found) for parser, found in texts.items()}


def _read(name: str, text: str, kind: type) -> Any:
    try:
        return TRUTHS[text.lower()] if kind is bool else kind(text)
    except (KeyError, ValueError):
        raise ValueError(f"--config {name}={text} has to be of type {kind.__name__}.") from None
