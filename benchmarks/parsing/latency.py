"""How fast parsers answer: single commands on one thread, and batches on all cores.

    GPSR_SHARED_DATA=… .venv/bin/python -m benchmarks.parsing.latency --parsers knn,seq2seq
    … benchmarks/parsing/latency.py --parsers knn --saved FOLDER      # a saved parser

Trains each parser on the generated and paraphrased commands of the published corpus, then parses its
validation utterances one by one on one thread, and in batches of 64 on as many threads as there are cores,
with a beam of 5. Percentiles are over single parses, after a warm-up.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

# Read once, when numpy and torch are loaded.
for name in ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[name] = "1"

import numpy as np  # noqa: E402

from benchmarks.fresh_site import DATA, WORLD, Site  # noqa: E402

MOST_MILLISECONDS = 15.0
LEAST_A_SECOND = 300.0
BATCH = 64
CORES = os.cpu_count() or 1
WARM_UP = 10


def measure(name: str, protocol: str, saved: Path | None) -> None:
    """Train or load a parser and print its line."""
    from annotations.models import World
    from parser_service.benchmarking.corpus import read_corpus
    from parser_service.parsers.registry import load_class, make_config
    from parser_service.runs.knowledge import knowledge_of

    corpus, sources = read_corpus(DATA / "walker2019", "command"), ("generated", "paraphrased")
    knowledge = knowledge_of(World.objects.get(name=WORLD), protocol)
    if saved:
        parser = load_class(name).load(saved, knowledge)
    else:
        parser = load_class(name)(make_config(name), 0, knowledge)
        parser.fit(corpus.pairs("train", sources), corpus.pairs("validation", sources))
    asked = [pair.utterance for pair in corpus.pairs("validation", sources)]
    use_threads(parser, 1)
    singles = seconds_of(parser, [[utterance] for utterance in asked])
    use_threads(parser, CORES)
    batches = seconds_of(parser, list(batched(asked * 4)))
    report(f"{name}, {protocol}", singles, 4 * len(asked) / sum(batches))


def use_threads(parser: Any, number: int) -> None:
    """Set the threads of a parser that has a setting for them, and those of torch where it is loaded."""
    if hasattr(parser.config, "threads"):
        parser.config = replace(parser.config, threads=number)
    if torch := sys.modules.get("torch"):
        torch.set_num_threads(number)


def batched(utterances: Sequence[str]) -> Iterator[Sequence[str]]:
    for start in range(0, len(utterances), BATCH):
        yield utterances[start : start + BATCH]


def seconds_of(parser: Any, calls: Sequence[Sequence[str]]) -> list[float]:
    """Return the seconds of each call of ``predict``, after some that are not counted."""
    from parser_service.runs.evaluating import BEAM_WIDTH

    for utterances in calls[:WARM_UP]:
        parser.predict(utterances, BEAM_WIDTH)
    seconds = []
    for utterances in calls:
        began = time.perf_counter()
        parser.predict(utterances, BEAM_WIDTH)
        seconds.append(time.perf_counter() - began)
    return seconds


def report(name: str, singles: Sequence[float], rate: float) -> None:
    middle, slow = 1000 * np.percentile(singles, [50, 95])
    single = "held" if slow <= MOST_MILLISECONDS else "MISSED"
    batch = "held" if rate >= LEAST_A_SECOND else "MISSED"
    print(
        f"p50 {middle:6.2f} ms  p95 {slow:6.2f} ms  {rate:7.0f} a second on {CORES} cores  {name}   "
        f"(bound p95 {MOST_MILLISECONDS:g} ms: {single}; {LEAST_A_SECOND:g} a second: {batch})",
        flush=True,
    )


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    arguments.add_argument("--parsers", required=True, metavar="A,B")
    arguments.add_argument("--protocol", help="measure only this protocol")
    arguments.add_argument("--saved", type=Path, help="folder of a saved parser of that protocol")
    given = arguments.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder) / "var")
        site.import_world()
        site.enter()
        from parser_service.parsers.registry import entry

        try:
            for name in given.parsers.split(","):
                for protocol in entry(name).protocols:
                    if given.protocol in (None, protocol):
                        measure(name, protocol, given.saved)
        except (ValueError, OSError) as error:
            sys.exit(str(error))


if __name__ == "__main__":
    main()
