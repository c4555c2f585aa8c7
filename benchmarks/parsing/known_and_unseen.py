"""How a ranker trained by form answers unseen forms, and utterances of the forms that it knows.

    GPSR_SHARED_DATA=… .venv/bin/python -m benchmarks.parsing.known_and_unseen --protocols strict,domain

Trains on the published split by form, without one in ten source commands of the training paraphrases. Asks the
validation paraphrases, whose forms training does not show (*unseen*), and the paraphrases of those source
commands (*known*). Prints both shares of right answers and their harmonic mean (Xian et al. 2018), and how they
change where a new form has to fit better or worse by some nats than the parser decided.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING

import pandas as pd

from benchmarks.fresh_site import DATA, WORLD, Site

if TYPE_CHECKING:  # the project can be imported only after a site was entered
    from parser_service.parsers.interface import Pair, Parser

MOVES = [step / 2 for step in range(-6, 7)]  # nats
EVERY_FORM = sys.maxsize  # answers to an utterance
SHARE = 0.1  # of the source commands


def hold_out(
    pairs: Sequence[Pair], source_of: Callable[[Pair], str]
) -> tuple[list[Pair], list[Pair]]:
    """Return the training pairs without a share of the source commands, and the paraphrases of those. No form
    loses its last source command."""
    sources = defaultdict(set)
    for pair in pairs:
        sources[pair.form].add(source_of(pair))
    several = sorted({source for those in sources.values() if len(those) > 1 for source in those})
    held: set[str] = set()
    for source in Random(0).sample(several, len(several)):
        if len(held) >= SHARE * len(several):
            break
        if all(those - held - {source} for those in sources.values() if source in those):
            held.add(source)
    kept = [pair for pair in pairs if source_of(pair) not in held]
    asked = [pair for pair in pairs if source_of(pair) in held and pair.source == "paraphrased"]
    return kept, asked


def train(protocol: str, setting: str, seed: int) -> tuple[Parser, dict[str, list[Pair]]]:
    """Return the parser and what to ask it."""
    from annotations.models import World
    from parser_service.benchmarking.corpus import read_corpus, source_commands
    from parser_service.parsers.conditions import Setting, sources_of
    from parser_service.parsers.registry import load_class, make_config
    from parser_service.runs.knowledge import anonymizer_of, knowledge_of

    world = World.objects.get(name=WORLD)
    corpus = read_corpus(DATA / "walker2019", "logical_form")
    anonymize = anonymizer_of(world)
    sources = source_commands(DATA / "walker2019", anonymize)
    names = sources_of(Setting.read(setting).train_sources)
    kept, known = hold_out(
        corpus.pairs("train", names),
        lambda pair: sources.get(pair.utterance) or anonymize(pair.utterance),
    )
    parser = load_class("ranker")(make_config("ranker"), seed, knowledge_of(world, protocol))
    parser.fit(kept, corpus.pairs("validation", names))
    unseen = corpus.pairs("validation", ["paraphrased"])
    return parser, {"unseen": unseen, "known": known, "training": kept}


def answers(parser: Parser, pairs: Sequence[Pair], forms: set[str]) -> Iterator[dict[str, float]]:
    """Yield for every utterance and every change whether the answer is right."""
    said = [pair.utterance for pair in pairs]
    for pair, ranked in zip(pairs, parser.predict(said, EVERY_FORM), strict=True):
        for move in MOVES:
            best = max(ranked, key=lambda each: each.score - move * (each.form not in forms))
            yield {"move": move, "right": 100.0 * (best.form == pair.form)}


def curve(protocol: str, setting: str, seed: int) -> pd.DataFrame:
    """Return the shares of right answers, one row a change of the threshold."""
    parser, asked = train(protocol, setting, seed)
    forms = {pair.form for pair in asked["training"]}
    shares = {
        name: pd.DataFrame(answers(parser, pairs, forms)).groupby("move")["right"].mean()
        for name, pairs in asked.items()
    }
    table = pd.DataFrame(shares)
    table["harmonic mean"] = 2 / (1 / table["unseen"] + 1 / table["known"])
    return table


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--protocols", default="strict,domain", metavar="A,B")
    parser.add_argument("--train-test", default="gen+para-para")
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder) / "var")
        site.import_world()
        site.enter()
        for protocol in given.protocols.split(","):
            table = curve(protocol, given.train_test, given.seed)
            print(f"\n{protocol}, {given.train_test}, seed {given.seed}")
            print(table.round(1).to_string(), flush=True)


if __name__ == "__main__":
    main()
