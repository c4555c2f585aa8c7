"""Verb: ask for the runs by which a new installation shows what it can do."""

from __future__ import annotations

from collections.abc import Mapping

from annotations.models import Split
from annotations.models.splits import Criterion
from parser_service import lifecycle
from parser_service.models import TrainingRun

# Parser, protocol, criterion of the split, train sources; the quick ones first, then the best.
FIRST_RUNS = (
    ("grammar-oracle", "grammar", Criterion.COMMAND, "gen+para"),
    ("knn", "strict", Criterion.COMMAND, "gen+para"),
    ("seq2seq", "strict", Criterion.COMMAND, "gen+para"),
    ("ranker", "strict", Criterion.COMMAND, "gen+para"),
    ("knn", "strict", Criterion.LOGICAL_FORM, "gen+para"),
)


def request_first_runs(splits: Mapping[Criterion, Split]) -> None:
    """Queues the first runs of splits that have had none; what is there already stays."""
    untouched = {
        criterion: split
        for criterion, split in splits.items()
        if not TrainingRun.objects.filter(split=split).exists()
    }
    for parser, protocol, criterion, sources in FIRST_RUNS:
        if criterion in untouched:
            split = untouched[criterion]
            lifecycle.request(split.world, split, parser, None, protocol, sources)
