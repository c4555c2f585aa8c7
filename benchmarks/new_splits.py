"""The ranker on new splits of the published pairs by source command."""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd
from fresh_site import DATA, WORLD, Site

if TYPE_CHECKING:  # the project is importable only once a site was entered
    from parser_service.parsers.interface import Pair, Parser

SETTINGS = ("para-para", "gen+para-para")
PROTOCOL, CRITERION = "domain", "source_command"


@dataclass(frozen=True, slots=True)
class Trained:
    """The ranker after the train pairs of a split, calibrated on its validation pairs; the forms that
    it was shown; and the paraphrases of the two other parts."""

    parser: Parser
    known: frozenset[str]
    held_out: Mapping[str, Sequence[Pair]]


def table_of(about: str, splits: str, answers: Callable[[Trained], Iterator[dict]]) -> pd.DataFrame:
    """What ``answers`` says of the ranker on each split that the command line asks for, a row each.

    ``splits`` are the default. A training takes a few minutes.
    """
    parser = argparse.ArgumentParser(description=about)
    parser.add_argument("--splits", default=splits, help="their numbers, separated by commas")
    parser.add_argument("--setting", default=SETTINGS[0], choices=SETTINGS)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder) / "var")
        site.import_world()
        site.enter()
        return pd.DataFrame(
            {"split": split, **row}
            for split in map(int, given.splits.split(","))
            for row in answers(_trained(split, given.setting))
        )


def _trained(split: int, setting: str) -> Trained:
    from annotations.models import World
    from parser_service.knowledge import knowledge_of
    from parser_service.management.commands.benchmark import corpus_of
    from parser_service.models.runs import TrainSources
    from parser_service.parsers.registry import load_class, make_config

    world = World.objects.get(name=WORLD)
    corpus = corpus_of(DATA / "walker2019", CRITERION, split, world)
    sources = TrainSources(setting.rpartition("-")[0]).sources
    train = corpus.pairs("train", sources)
    knowledge = knowledge_of(world, PROTOCOL).limited_to(PROTOCOL)
    parser = load_class("ranker")(make_config("ranker"), 0, knowledge)
    parser.fit(train, corpus.pairs("validation", sources))
    held_out = {part: corpus.pairs(part, ["paraphrased"]) for part in ("validation", "test")}
    return Trained(parser, frozenset(pair.form for pair in train), held_out)
