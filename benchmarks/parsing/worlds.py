"""The ranker, or the linear classifier, in worlds of other sizes: seconds, memory, disk, milliseconds of an answer.

    GPSR_SHARED_DATA=… .venv/bin/python -m benchmarks.parsing.worlds [--worlds "one pair,10000 forms"] [--parser linear]

Each world is made up and trained in a process of its own, under *strict*, on two cores. Half-way the training is
cancelled, which is timed, and resumed from its last checkpoint; the seconds are those of both together. (``linear``
has no checkpoint and begins anew.) Disk is the most that checkpoints and the saved parser take. Answers are single
ones on one thread. ``--steps`` trains the ranker less.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from itertools import islice, product
from pathlib import Path
from random import Random
from shutil import rmtree

# Read once, when numpy and torch are loaded.
for variable in ("OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(variable, "2")

from parser_service.parsers.interface import Cancelled, Observer, Pair, Parser  # noqa: E402

VERBS = """
bring find take fetch carry move get push pull hold lift place show clean wash check open close
fill empty pour serve drop throw catch hide stack sort count weigh wipe dry fold pack wrap cut
cook heat cool test look follow guide greet turn mix peel roll shake press
""".split()  # noqa: SIM905
LOOKS = """
red blue green small large heavy light round square soft hard wet old dirty full long short
wide narrow thick thin warm cold fresh sweet sour bitter salty bright dark shiny plain striped
spotted wooden plastic metal paper glass broken flat curved sharp smooth rough clear black
white brown grey
""".split()  # noqa: SIM905
PLACES = {
    "": "",
    ' ( at $1 " <room> " )': "in the <room>",
    ' ( at $1 " <location> " )': "from the <location>",
    ' ( left_of $1 " <object> " )': "left of the <object>",
}
OPENINGS = (
    "", "please", "robot", "could you", "can you", "would you", "I want you to", "you should", "go and",
    "now", "I need you to", "kindly", "help me and", "it is time to", "try to", "remember to",
    "will you", "be so kind and", "I would like you to", "your task is to",
)  # fmt: skip
# Forms, pairs, and their source. The bounds are seconds, megabytes of memory and disk, and milliseconds.
WORLDS = {
    "one pair": (1, 1, "paraphrased"),
    "50 paraphrases": (20, 50, "paraphrased"),
    "2000 commands": (200, 2000, "generated"),
    "10000 forms": (10_000, 20_000, "generated"),
    "200000 commands": (10_000, 200_000, "generated"),
}
MOST_SECONDS, MOST_MEMORY, MOST_DISK = 900, 3072, 1024
MOST_CANCELLING = 5.0
CHECKPOINT_EVERY = 20.0
ASKED = 60


def made_up(forms: int, pairs: int, source: str) -> list[Pair]:
    """Return so many pairs of so many forms, each form said with several openings."""
    combined = list(product(VERBS, LOOKS, PLACES.items()))
    chosen = Random(0).sample(combined, forms)
    said = (
        Pair(
            " ".join(f"{opening} {verb} the {look} <object> {place}".split()),
            f'( {verb} ( lambda $1 e ( is_a $1 " <object> " ) ( {look} $1 ){where} ) )',
            source,
        )
        for opening, (verb, look, (where, place)) in product(OPENINGS, chosen)
    )
    return list(islice(said, pairs))


class Keeper(Observer):
    """Keeps the last checkpoint, as a run does, and the most bytes that were on the disk at once."""

    def __init__(self, folder: Path):
        self.folder = folder
        self.kept = time.monotonic()
        self.most_bytes = 0
        self.cancelled_at: float | None = None
        self.half_way: Callable[[], None] = lambda: None

    def check(self) -> None:
        if self.cancelled_at is not None:
            raise Cancelled

    def progress(self, fraction: float, message: str = "") -> None:
        if fraction > 0.5:
            self.half_way()

    def log(self, message: str) -> None:
        print(f"  {message}", file=sys.stderr, flush=True)

    def is_checkpoint_due(self) -> bool:
        return time.monotonic() - self.kept >= CHECKPOINT_EVERY

    def checkpoint(self, epoch: int, is_best: bool, write: Callable[[Path], None]) -> None:
        write(self.folder / "new")
        self.most_bytes = max(self.most_bytes, size_of(self.folder))
        rmtree(self.folder / "last", ignore_errors=True)
        (self.folder / "new").rename(self.folder / "last")
        self.kept = time.monotonic()

    def last_checkpoint(self) -> Path | None:
        last = self.folder / "last"
        return last if last.is_dir() else None


def size_of(folder: Path) -> int:
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())


def measure(name: str, kind: str, steps: int) -> dict[str, float]:
    """Train, cancel, resume, save and ask in this process."""
    from parser_service.parsers.registry import load_class, make_config

    pairs = made_up(*WORLDS[name])
    make = load_class(kind)
    config = make_config(kind, {"threads": 2, "steps": steps} if kind == "ranker" else {})
    with tempfile.TemporaryDirectory() as folder:
        keeper = Keeper(Path(folder))
        began = time.monotonic()
        cancelling = cancel_half_way(make(config), pairs, keeper)
        parser = make(config)
        parser.fit(pairs, (), keeper)
        seconds = time.monotonic() - began
        rmtree(Path(folder) / "new", ignore_errors=True)
        parser.save(Path(folder) / "saved")
        disk = max(keeper.most_bytes, size_of(Path(folder)))
    return {
        "seconds": seconds,
        "cancelling": cancelling,
        "memory": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
        "disk": disk / 1024**2,
        "p95": latency(parser, pairs),
        "right": right(parser, pairs),
    }


def cancel_half_way(parser: Parser, pairs: list[Pair], keeper: Keeper) -> float:
    """Train until half of the steps are over and a person cancels; return the seconds until it stops."""
    timer = threading.Timer(0.2, lambda: setattr(keeper, "cancelled_at", time.monotonic()))

    def cancel_soon() -> None:
        keeper.half_way = lambda: None
        timer.start()

    keeper.half_way = cancel_soon
    try:
        parser.fit(pairs, (), keeper)
    except Cancelled:
        return time.monotonic() - (keeper.cancelled_at or 0.0)
    finally:
        timer.cancel()
        keeper.cancelled_at, keeper.half_way = None, lambda: None
    return 0.0  # it was over before


def latency(parser: Parser, pairs: list[Pair]) -> float:
    """Return the 95th percentile of the milliseconds of single answers on one thread."""
    if torch := sys.modules.get("torch"):
        torch.set_num_threads(1)
    milliseconds = []
    for pair in Random(1).choices(pairs, k=ASKED + 10):
        began = time.perf_counter()
        parser.predict([pair.utterance], 5)
        milliseconds.append(1000 * (time.perf_counter() - began))
    return sorted(milliseconds[10:])[int(0.95 * ASKED)]


def right(parser: Parser, pairs: list[Pair]) -> float:
    """Return the share of training utterances that are answered right, in percent."""
    some = Random(2).choices(pairs, k=200)
    answers = parser.predict([pair.utterance for pair in some])
    correct = sum(ranked[0].form == pair.form for ranked, pair in zip(answers, some, strict=True))
    return 100 * correct / len(some)


def report(name: str, of: dict[str, float]) -> bool:
    """Print a row; return whether the bounds held."""
    most_milliseconds = 40 if WORLDS[name][0] > 1000 else 15
    bounds = {
        "seconds": MOST_SECONDS,
        "memory": MOST_MEMORY,
        "disk": MOST_DISK,
        "p95": most_milliseconds,
        "cancelling": MOST_CANCELLING,
    }
    missed = [key for key, bound in bounds.items() if of[key] > bound]
    verdict = f"MISSED: {', '.join(missed)}" if missed else "held"
    print(
        f"| {name} | {of['seconds']:.0f} s | {of['memory']:.0f} MB | {of['disk']:.0f} MB | {of['p95']:.1f} ms "
        f"| {of['cancelling']:.1f} s | {of['right']:.0f} % | {verdict} |",
        flush=True,
    )
    return not missed


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    arguments.add_argument("--worlds", default=",".join(WORLDS), metavar="A,B")
    arguments.add_argument("--parser", choices=("ranker", "linear"), default="ranker")
    arguments.add_argument("--steps", type=int, default=400)
    arguments.add_argument("--one", help=argparse.SUPPRESS)
    given = arguments.parse_args()
    if given.one:
        print(json.dumps(measure(given.one, given.parser, given.steps)))
        return
    print(
        "| world | seconds | memory | disk | answer, p95 | cancelled in | right on its pairs | bounds |"
    )
    held = []
    for name in given.worlds.split(","):
        command = [sys.executable, "-m", "benchmarks.parsing.worlds", "--one", name]
        child = subprocess.run(
            [*command, "--parser", given.parser, "--steps", str(given.steps)],
            stdout=subprocess.PIPE,
            text=True,
            check=True,
        )
        held.append(report(name, json.loads(child.stdout)))
    if not all(held):
        sys.exit(1)


if __name__ == "__main__":
    main()
