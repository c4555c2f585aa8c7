"""What one ``manage.py parse`` costs, from the start of Python to the answer.

    .venv/bin/python -m benchmarks.parsing.parse_command [--parser ranker] [--times 5]

Loads the starter world into a fresh SQLite database, trains the parser there for a few steps (the
cost of loading does not depend on how well it has learned, but on how many forms it has), and then
runs the command several times. Seconds of processor time are user and system time together; the
smallest of the runs counts, because other work on the machine only adds.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

from benchmarks.fresh_site import Site

MOST_SECONDS = 6.0
STARTER = (
    "from annotations.exchange.starter_world import load_starter_world; load_starter_world(print)"
)
WORLD, SPLIT = "household", "by-command"
SHORT = {"ranker": ["steps=20"], "seq2seq": ["epochs=1"], "seq2seq-minilm": ["epochs=1"]}
UTTERANCE = "bring me the apple from the kitchen"


def run(site: Site, *arguments: str) -> float:
    """Return the seconds of processor time of one command. Exits where the command fails."""
    spent = site.run(*arguments)
    if spent.status:
        sys.exit(spent.errors)
    return spent.processor


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    arguments.add_argument("--parser", default="ranker")
    arguments.add_argument("--times", type=int, default=5, help="how often to run the command")
    given = arguments.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder) / "var")
        run(site, "shell", "-c", STARTER)
        config = SHORT.get(given.parser, [])
        where = ("--world", WORLD, "--split", SPLIT)
        run(site, "train", given.parser, *where, *(["--config", *config] if config else []))
        seconds = [run(site, "parse", UTTERANCE, "--world", WORLD) for _ in range(given.times)]
    best = min(seconds)
    verdict = "held" if best <= MOST_SECONDS else "MISSED"
    print(
        f"{best:.1f} s of processor time (up to {max(seconds):.1f} s)  {given.parser}   "
        f"(bound {MOST_SECONDS:g} s: {verdict})"
    )


if __name__ == "__main__":
    main()
