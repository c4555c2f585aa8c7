"""Read options of a command line: names, columns, train sources and hyperparameters."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import product
from typing import Any

from annotations.language.corpus import Criterion
from annotations.language.texts import Refusal
from parser_service.benchmarking.trials import Declared, TrialColumn
from parser_service.parsers.conditions import PAPERS_SETTINGS, SOURCES, TRAIN_SOURCES, Protocol
from parser_service.parsers.registry import config_fields, parsers

COLUMN_PARTS: tuple[Sequence[str], Sequence[str], Sequence[str]] = (
    [str(setting) for setting in PAPERS_SETTINGS],
    list(Criterion),
    list(Protocol),
)
TRUTHS = {"true": True, "yes": True, "1": True, "false": False, "no": False, "0": False}


def read_names(text: str | None, known: Sequence[str]) -> list[str]:
    """Read names with commas between them; None stands for all. Raises Refusal where one is not
    ``known``."""
    names = list(known) if text is None else [name.strip() for name in text.split(",")]
    for name in names:
        if name not in known:
            raise Refusal(f"{name!r} is not one of {', '.join(known)}.", "unknown_name")
    return names


def read_columns(
    columns: str | None, train_test: str | None, criteria: str | None, protocols: str | None
) -> list[TrialColumn]:
    """Read the columns that ``--columns`` lists, or else all combinations of what the three other
    options list. Raises Refusal."""
    if columns is None:
        named = map(read_names, (train_test, criteria, protocols), COLUMN_PARTS)
        return [TrialColumn(*parts) for parts in product(*named)]
    if train_test or criteria or protocols:
        raise Refusal(
            "--columns says all that --train-test, --criteria and --protocols say; leave either out.",
            "options_contradict",
        )
    return [read_column(text) for text in columns.split(",")]


def read_column(text: str) -> TrialColumn:
    """Read ``TRAIN-TEST:CRITERION:PROTOCOL`` or, under *domain*, ``…:DECLARED``. Raises Refusal."""
    *parts, last = text.split(":")
    declared: str = Declared.ALL
    if len(parts) == len(COLUMN_PARTS):
        (declared,) = read_names(last, list(Declared))
        if declared != Declared.ALL and parts[-1].strip() != Protocol.DOMAIN:
            raise Refusal(
                f"--columns {text!r}: which forms declare the predicates matters under domain alone.",
                "column_unreadable",
            )
    else:
        parts.append(last)
    if len(parts) != len(COLUMN_PARTS):
        settings, criteria, protocols = COLUMN_PARTS
        raise Refusal(
            f"--columns {text!r} has to be TRAIN-TEST:CRITERION:PROTOCOL, for example "
            f"{settings[-1]}:{criteria[0]}:{protocols[0]}.",
            "column_unreadable",
        )
    named = zip(parts, COLUMN_PARTS, strict=True)
    setting, criterion, protocol = (read_names(part, known)[0] for part, known in named)
    return TrialColumn(setting, criterion, protocol, declared)


def read_seeds(option: str, text: str, at_least: int = 0) -> range:
    """Read ``N`` as the seeds 0 to N - 1, ``A-B`` as those from A to B.

    Raises Refusal, a sentence that names the option, also where there are fewer than ``at_least``.
    """
    if match := re.fullmatch(r"(\d+)(?:-(\d+))?", text.strip()):
        first, last = match.groups()
        seeds = range(int(first)) if last is None else range(int(first), int(last) + 1)
        if seeds or (last is None and not at_least):
            return seeds
    raise Refusal(
        f"{option} is {text!r}; it has to be a number, {at_least} or more, or a range of seeds (6-9).",
        "seeds_unreadable",
    )


def read_sources(text: str) -> str:
    """Read ``para,gen``, in any order and with commas or pluses, as ``gen+para``. Raises Refusal."""
    named = set(text.replace(",", "+").split("+"))
    for sources in TRAIN_SOURCES:
        if named == set(sources.split("+")):
            return sources
    names = ", ".join(SOURCES)
    raise Refusal(
        f"--sources is {text!r}; it has to be one or more of {names}.", "sources_unreadable"
    )


def read_hyperparameters(parser: str, assignments: Sequence[str]) -> dict[str, Any]:
    """Read ``KEY=VALUE`` texts as values of the types that the parser declares. Raises Refusal."""
    types = {declared.name: declared.type for declared in config_fields(parser)}
    values = {}
    for assignment in assignments:
        name, is_assigned, text = assignment.partition("=")
        if not is_assigned:
            raise Refusal(
                f"--config {assignment!r} has to be KEY=VALUE.", "hyperparameter_unreadable"
            )
        # An unknown name is refused with the known ones when the config is made.
        kind = types.get(name, str)
        try:
            values[name] = TRUTHS[text.lower()] if kind is bool else kind(text)
        except (KeyError, ValueError):
            raise Refusal(
                f"--config {name}={text} has to be of type {kind.__name__}.",
                "hyperparameter_unreadable",
            ) from None
    return values


def read_configurations(assignments: Sequence[str]) -> dict[str, dict[str, Any]]:
    """Read ``PARSER.KEY=VALUE`` texts as hyperparameters by parser. Raises Refusal."""
    texts: dict[str, list[str]] = {}
    for assignment in assignments:
        parser, has_dot, rest = assignment.partition(".")
        if not has_dot or parser not in parsers():
            raise Refusal(
                f"--config {assignment!r} has to be PARSER.KEY=VALUE.", "hyperparameter_unreadable"
            )
        texts.setdefault(parser, []).append(rest)
    return {parser: read_hyperparameters(parser, own) for parser, own in texts.items()}
