"""What paraphrases are worth: accuracy on what people say, by the number of paraphrases that a parser learned from.

    .venv/bin/python -m benchmarks.parsing.worth_of_paraphrases [--parser linear] [--draws 5]

Trains on all generated pairs of the published split by command and on so many of its paraphrases, drawn anew for each
draw, and asks the paraphrases of the validation part. Writes the curve that worlds without runs of their own are shown,
parser_service/results/worth_of_paraphrases.json: exact match in percent with its 95 % interval, by a bootstrap of
source commands and draws. Takes a minute or two of one core.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from collections import defaultdict
from pathlib import Path
from random import Random
from typing import Any

from benchmarks.fresh_site import DATA, ROOT, WORLD, Site

RESULT = ROOT / "parser_service" / "results" / "worth_of_paraphrases.json"
NUMBERS = (0, 50, 100, 200, 400, 800)
PROTOCOL = "domain"


def measure(name: str, draws: int) -> dict[str, Any]:
    """Return the curve of a parser, with what it was measured on."""
    from annotations.models import World
    from parser_service.analysis.clustered import Clustered, Tally, interval_of
    from parser_service.benchmarking.missing_cells import load_corpus
    from parser_service.parsers.registry import load_class, make_config
    from parser_service.runs.knowledge import knowledge_of

    world = World.objects.get(name=WORLD)
    corpus = load_corpus(DATA / "walker2019", "command", None, world)
    generated = corpus.pairs("train", ["generated"])
    said = corpus.pairs("train", ["paraphrased"])
    asked = corpus.pairs("validation", ["paraphrased"])
    knowledge = knowledge_of(world, PROTOCOL).limited_to(PROTOCOL)
    points = []
    for number in (*NUMBERS, len(said)):
        tallies: list[Tally] = []
        for seed in range(draws):
            train = [*generated, *Random(seed).sample(said, number)]
            parser = load_class(name)(make_config(name), seed, knowledge)
            sources = ["generated", "paraphrased"] if number else ["generated"]
            parser.fit(train, corpus.pairs("validation", sources))
            answers = parser.predict([pair.utterance for pair in asked])
            right: dict[str, list[bool]] = defaultdict(list)
            for ranked, pair in zip(answers, asked, strict=True):
                is_right = bool(ranked) and ranked[0].form == pair.form
                right[corpus.cluster(pair)].append(is_right)
            tallies.append({key: (sum(each), len(each)) for key, each in right.items()})
        counted = Clustered.of(tallies)
        low, high = interval_of((counted,))
        point = [number, *(round(100 * each, 1) for each in (counted.accuracies.mean(), low, high))]
        points.append(point)
        print(*point, flush=True)
    return {
        "parser": name,
        "forms": len({pair.form for pair in [*generated, *said]}),
        "generated": len(generated),
        "validation": len(asked),
        "draws": draws,
        "points": points,
    }


def main() -> None:
    given_by = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    given_by.add_argument("--parser", default="linear")
    given_by.add_argument("--draws", type=int, default=5)
    given = given_by.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder) / "var")
        site.import_world()
        site.enter()
        RESULT.write_text(json.dumps(measure(given.parser, given.draws), indent=1) + "\n", "utf-8")


if __name__ == "__main__":
    main()
