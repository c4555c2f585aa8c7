"""In what the configurations of runs differ: only that, side by side."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from parser_service.models import TrainingRun
from parser_service.parsers.registry import title_of

# What a run has beside its hyperparameters, as pages call it.
OF_A_RUN: dict[str, Callable[[TrainingRun], Any]] = {
    "parser": lambda run: title_of(run.parser),
    "version": lambda run: run.parser_version,
    "protocol": lambda run: run.protocol,
    "trained on": lambda run: run.train_sources,
    "share of the pairs": lambda run: run.train_share,
    "seed": lambda run: run.seed,
}
NOT_THERE = None  # a hyperparameter that a parser does not have


@dataclass(frozen=True, slots=True)
class DifferentSetting:
    """One thing that not all runs have alike; ``values`` in their order, None where a parser has nothing of it."""

    name: str
    values: tuple[Any, ...]


@dataclass(frozen=True, slots=True)
class ConfigurationDifference:
    """``rows`` are what differs between runs that have it; ``own`` what only some parsers have, ``n_equal`` how much is
    the same for all."""

    rows: tuple[DifferentSetting, ...]
    own: tuple[DifferentSetting, ...]
    n_equal: int


def difference_of(runs: Sequence[TrainingRun]) -> ConfigurationDifference:
    """Compare what was configured for ``runs``. Time grows with their hyperparameters."""
    names = dict.fromkeys(name for run in runs for name in run.config)
    settings = [
        *(DifferentSetting(name, tuple(map(read, runs))) for name, read in OF_A_RUN.items()),
        *(DifferentSetting(name, tuple(run.config.get(name) for run in runs)) for name in names),
    ]
    rows, own, n_equal = [], [], 0
    for each in settings:
        held = [run for run in runs if each.name in OF_A_RUN or each.name in run.config]
        if len({repr(value) for value in each.values}) == 1:
            n_equal += 1
        elif len(held) == len(runs):
            rows.append(each)
        else:
            own.append(each)
    return ConfigurationDifference(tuple(rows), tuple(own), n_equal)
