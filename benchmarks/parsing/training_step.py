"""Where a training of the ranker spends its time: milliseconds per step, and the most expensive operations.

    GPSR_SHARED_DATA=… .venv/bin/python -m benchmarks.parsing.training_step --threads 1

Trains on a third of the generated and paraphrased commands of the published corpus, under *strict*, for a
few passes. The fastest pass counts: the first includes compilation by torch, and some include encoding all
examples. A second training runs under torch's profiler, which makes it slower.
"""

from __future__ import annotations

import argparse

from torch.profiler import ProfilerActivity, profile

from benchmarks.fresh_site import DATA
from parser_service.benchmarking.corpus import read_corpus
from parser_service.neural.ranker.form_ranker import FormRanker
from parser_service.parsers.hyperparameters.ranker import RankerConfig
from parser_service.parsers.interface import EpochReport, Observer, Pair

PASSES = 6
MOST_OPERATIONS = 12


class PassTimes(Observer):
    """Keeps the seconds of every pass."""

    def __init__(self) -> None:
        self.seconds: list[float] = []

    def epoch(self, report: EpochReport) -> None:
        self.seconds.append(report.seconds)


def train(pairs: list[Pair], steps: int, threads: int) -> list[float]:
    """The seconds of each pass."""
    clock = PassTimes()
    FormRanker(RankerConfig(steps=steps, threads=threads, forms="closed")).fit(pairs, (), clock)
    return clock.seconds


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    arguments.add_argument("--threads", type=int, default=1, metavar="N")
    threads = arguments.parse_args().threads
    corpus = read_corpus(DATA / "walker2019", "command")
    pairs = corpus.pairs("train", ("generated", "paraphrased"))[::3]
    batches = -(-len(pairs) // RankerConfig().batch_size)
    seconds = train(pairs, PASSES * batches, threads)
    print(
        f"{1000 * min(seconds) / batches:.0f} ms per step ({batches} steps per pass; threads: {threads})"
    )
    with profile(activities=[ProfilerActivity.CPU]) as profiled:
        train(pairs, batches, threads)
    print(profiled.key_averages().table("self_cpu_time_total", row_limit=MOST_OPERATIONS))


if __name__ == "__main__":
    main()
