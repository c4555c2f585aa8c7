"""Verb: request the runs that show what a new installation can do."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from annotations.language.corpus import Criterion
from annotations.models import Split
from parser_service.models import TrainingRun
from parser_service.runs import run_requests


class FirstRun(NamedTuple):
    """A run to request; ``config`` holds the hyperparameters that differ from their defaults."""

    parser: str
    protocol: str
    criterion: Criterion
    sources: str
    config: Mapping[str, Any] = {}


# First those that take seconds: ``knn`` so that a robot is answered early, ``linear`` so that it is answered well.
# The ranker, which is the best one, uses all cores, since nothing else computes on a new installation, and half of
# its usual steps, which are enough for the starter world.
FIRST_RUNS = (
    FirstRun("knn", "strict", Criterion.COMMAND, "gen+para"),
    FirstRun("linear", "domain", Criterion.COMMAND, "gen+para"),
    FirstRun("grammar-oracle", "grammar", Criterion.COMMAND, "gen+para"),
    FirstRun("ranker", "strict", Criterion.COMMAND, "gen+para", {"threads": 0, "steps": 200}),
    FirstRun("seq2seq", "strict", Criterion.COMMAND, "gen+para"),
    FirstRun("knn", "strict", Criterion.LOGICAL_FORM, "gen+para"),
)


def request_first_runs(splits: Mapping[Criterion, Split]) -> None:
    """Queue the first runs of the splits that have no run yet."""
    untouched = {
        criterion: split
        for criterion, split in splits.items()
        if not TrainingRun.objects.filter(split=split).exists()
    }
    for run in FIRST_RUNS:
        if run.criterion in untouched:
            split = untouched[run.criterion]
            run_requests.request(
                split.world, split, run.parser, run.config, run.protocol, run.sources
            )
