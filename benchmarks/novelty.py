"""By how much new forms should have to fit better than known ones: accuracy by the threshold.

    GPSR_SHARED_DATA=… .venv/bin/python benchmarks/novelty.py [--splits 1,2,4,5] [--setting para-para]

Trains the ranker (domain, seed 0) on new splits by source command, a few minutes each, and asks it for the
paraphrases of the test parts. Then moves the threshold from where it is: by so many nats a new form has to fit
better (or, below 0, worse). By move: the share of new forms among the answers and exact match, %.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pandas as pd
from fresh_site import Site
from new_splits import SETTINGS, trained

MOVES = [step / 2 for step in range(-6, 7)]  # nats


def answers(split: int, setting: str) -> Iterator[dict[str, float]]:
    """Every test paraphrase of a split after every move: whether a new form is answered, the right one."""
    from parser_service.models.runs import TrainSources

    parser, corpus = trained(split, setting)
    sources = TrainSources(setting.rpartition("-")[0]).sources
    known = {pair.form for pair in corpus.pairs("train", sources)}
    pairs = corpus.pairs("test", ["paraphrased"])
    everything = 1_000_000  # all forms, each with its log-probability
    for pair, ranked in zip(
        pairs, parser.predict([pair.utterance for pair in pairs], everything), strict=True
    ):
        for move in MOVES:
            best = max(ranked, key=lambda each: each.score - move * (each.form not in known))
            yield {
                "split": split,
                "move": move,
                "new": 100.0 * (best.form not in known),
                "exact": 100.0 * (best.form == pair.form),
            }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--splits", default="1,2,4,5", help="their numbers, separated by commas")
    parser.add_argument("--setting", default=SETTINGS[0], choices=SETTINGS)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder) / "var")
        site.import_world()
        site.enter()
        splits = [int(number) for number in given.splits.split(",")]
        table = pd.DataFrame(row for split in splits for row in answers(split, given.setting))
    by_move = table.groupby("move")
    exact = table.pivot_table(index="move", columns="split", values="exact").add_prefix("split ")
    print(by_move[["new", "exact"]].mean().join(exact).round(1).to_string())


if __name__ == "__main__":
    main()
