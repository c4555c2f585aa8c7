"""The ranker on new splits of the published pairs by source command."""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from benchmarks.fresh_site import DATA, WORLD, Site

if TYPE_CHECKING:  # the project can be imported only after a site was entered
    from parser_service.parsers.interface import Pair, Parser

SETTINGS = ("para-para", "gen+para-para")
PROTOCOL, CRITERION = "domain", "source_command"


@dataclass(frozen=True, slots=True)
class Trained:
    """A ranker trained on the train pairs of a split and calibrated on its validation pairs; the forms of
    its training pairs; and the paraphrases of the two other parts."""

    parser: Parser
    known: frozenset[str]
    held_out: Mapping[str, Sequence[Pair]]


def table_of(
    about: str, splits: str, answers: Callable[[Trained], Iterator[Mapping[str, object]]]
) -> pd.DataFrame:
    """Return the rows that ``answers`` yields for the ranker on each split that the command line names.

    ``splits`` is the default. A training takes a few minutes.
    """
    parser = argparse.ArgumentParser(description=about)
    parser.add_argument("--splits", default=splits, help="their numbers, separated by commas")
    parser.add_argument("--train-test", default=SETTINGS[0], choices=SETTINGS)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder) / "var")
        site.import_world()
        site.enter()
        return pd.DataFrame(
            {"split": split, **row}
            for split in map(int, given.splits.split(","))
            for row in answers(_train(split, given.train_test))
        )


def _train(split: int, setting: str) -> Trained:
    from annotations.models import World
    from parser_service.benchmarking.missing_cells import load_corpus
    from parser_service.parsers.conditions import Setting, sources_of
    from parser_service.parsers.registry import load_class, make_config
    from parser_service.runs.knowledge import knowledge_of

    world = World.objects.get(name=WORLD)
    corpus = load_corpus(DATA / "walker2019", CRITERION, split, world)
    sources = sources_of(Setting.read(setting).train_sources)
    train = corpus.pairs("train", sources)
    knowledge = knowledge_of(world, PROTOCOL).limited_to(PROTOCOL)
    parser = load_class("ranker")(make_config("ranker"), 0, knowledge)
    parser.fit(train, corpus.pairs("validation", sources))
    held_out = {part: corpus.pairs(part, ["paraphrased"]) for part in ("validation", "test")}
    return Trained(parser, frozenset(pair.form for pair in train), held_out)
