"""Read options of a command line: names, columns, train sources and hyperparameters."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import product
from typing import Any

from annotations.language.corpus import Criterion
from parser_service.benchmarking.jobs import Column, Declared
from parser_service.parsers.conditions import SETTINGS, Protocol, TrainSources
from parser_service.parsers.registry import PARSERS, config_fields

COLUMN_PARTS = ([str(setting) for setting in SETTINGS], list(Criterion), list(Protocol))
TRUTHS = {"true": True, "yes": True, "1": True, "false": False, "no": False, "0": False}


def read_names(text: str | None, known: Sequence[str]) -> list[str]:
    """Read names with commas between them; None stands for all. Raises ValueError where one is not
    ``known``."""
    names = list(known) if text is None else [name.strip() for name in text.split(",")]
    for name in names:
        if name not in known:
            raise ValueError(f"{name!r} is not one of {', '.join(known)}.")
    return names


def read_columns(
    columns: str | None, train_test: str | None, criteria: str | None, protocols: str | None
) -> list[Column]:
    """Read the columns that ``--columns`` lists, or else all combinations of what the three other
    options list. Raises ValueError."""
    if columns is None:
        named = map(read_names, (train_test, criteria, protocols), COLUMN_PARTS)
        return [Column(*parts) for parts in product(*named)]
    if train_test or criteria or protocols:
        raise ValueError(
            "--columns says all that --train-test, --criteria and --protocols say; leave either out."
        )
    return [read_column(text) for text in columns.split(",")]


def read_column(text: str) -> Column:
    """Read ``TRAIN-TEST:CRITERION:PROTOCOL`` or, under *domain*, ``…:DECLARED``. Raises ValueError."""
    *parts, last = text.split(":")
    declared = Declared.ALL
    if len(parts) == len(COLUMN_PARTS):
        (declared,) = read_names(last, list(Declared))
        if declared != Declared.ALL and parts[-1].strip() != Protocol.DOMAIN:
            raise ValueError(
                f"--columns {text!r}: which forms declare the predicates matters under domain alone."
            )
    else:
        parts.append(last)
    if len(parts) != len(COLUMN_PARTS):
        settings, criteria, protocols = COLUMN_PARTS
        raise ValueError(
            f"--columns {text!r} has to be TRAIN-TEST:CRITERION:PROTOCOL, for example "
            f"{settings[-1]}:{criteria[0]}:{protocols[0]}."
        )
    named = zip(parts, COLUMN_PARTS, strict=True)
    return Column(*(read_names(part, known)[0] for part, known in named), declared)


def read_seeds(option: str, text: str, at_least: int = 0) -> range:
    """Read ``N`` as the seeds 0 to N - 1, ``A-B`` as those from A to B.

    Raises ValueError, a sentence that names the option, also where there are fewer than ``at_least``.
    """
    if match := re.fullmatch(r"(\d+)(?:-(\d+))?", text.strip()):
        first, last = match.groups()
        seeds = range(int(first)) if last is None else range(int(first), int(last) + 1)
        if seeds or (last is None and not at_least):
            return seeds
    raise ValueError(
        f"{option} is {text!r}; it has to be a number, {at_least} or more, or a range of seeds (6-9)."
    )


def read_sources(text: str) -> str:
    """Read ``gen,para``, in either order and with a comma or a plus, as ``gen+para``. Raises ValueError."""
    named = set(text.replace(",", "+").split("+"))
    for sources in TrainSources:
        if named == set(sources.split("+")):
            return str(sources)
    raise ValueError(f"--sources is {text!r}; it has to be gen, para or gen,para.")


def read_hyperparameters(parser: str, assignments: Sequence[str]) -> dict[str, Any]:
    """Read ``KEY=VALUE`` texts as values of the types that the parser declares. Raises ValueError."""
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
    """Read ``PARSER.KEY=VALUE`` texts as hyperparameters by parser. Raises ValueError."""
    texts: dict[str, list[str]] = {}
    for assignment in assignments:
        parser, has_dot, rest = assignment.partition(".")
        if not has_dot or parser not in PARSERS:
            raise ValueError(f"--config {assignment!r} has to be PARSER.KEY=VALUE.")
        texts.setdefault(parser, []).append(rest)
    return {parser: read_hyperparameters(parser, own) for parser, own in texts.items()}


def _read(name: str, text: str, kind: type) -> Any:
    try:
        return TRUTHS[text.lower()] if kind is bool else kind(text)
    except (KeyError, ValueError):
        raise ValueError(f"--config {name}={text} has to be of type {kind.__name__}.") from None
