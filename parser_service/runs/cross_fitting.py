"""Score the validation part by parsers that were calibrated on other pairs of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from parser_service.analysis.clustered import folds_of
from parser_service.parsers.interface import Pair, Parser

FOLDS = 2


def calibrated_folds(
    parser: Parser,
    asked: Sequence[str],
    calibrating: Sequence[Pair],
    clusters: Sequence[str],
) -> Iterator[tuple[Parser, list[int]]]:
    """Yield a parser for each fold of the validation part, and the places of what it has to answer.

    A fold is half of the clusters; its parser is calibrated on the pairs of the other half. Everything is
    one fold, answered by ``parser`` itself, where nothing is calibrated, and where there is one cluster.

    Args:
        asked: the cluster of each example to answer, [examples].
        calibrating: the validation pairs that calibrated ``parser``, [pairs].
        clusters: that of each of them, [pairs].
    """
    folds = folds_of([*asked, *clusters], FOLDS)
    if not folds or not calibrating or parser.calibrated(calibrating[:1]) is parser:
        yield parser, list(range(len(asked)))
        return
    for fold in range(FOLDS):
        others = [
            pair
            for pair, cluster in zip(calibrating, clusters, strict=True)
            if folds[cluster] != fold
        ]
        places = [at for at, cluster in enumerate(asked) if folds[cluster] == fold]
        if places:
            yield parser.calibrated(others), places
