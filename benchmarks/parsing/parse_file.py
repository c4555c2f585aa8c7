"""What ``manage.py parse --file`` costs with the grammar oracle, from the start of Python to the last answer.

    GPSR_SHARED_DATA=… .venv/bin/python -m benchmarks.parsing.parse_file [--file LINES] [--grammar FOLDER] [--times 3]

Loads the starter world, or the grammar and templates of a folder, into a fresh SQLite database, imports a
competition's folder there, and parses every line of its commands several times. Seconds of processor time are user and
system time together; the smallest of the runs counts, because other work on the machine only adds.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

from benchmarks.fresh_site import DATA, Site
from benchmarks.parsing.parse_command import STARTER, WORLD, run

MOST_SECONDS = 90.0
COMPETITION = DATA / "competition-2025"


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    arguments.add_argument("--file", type=Path, default=COMPETITION / "commands.jsonl")
    arguments.add_argument(
        "--grammar", type=Path, help="files of a generator, in place of the starter world"
    )
    arguments.add_argument("--times", type=int, default=3, help="how often to run the command")
    given = arguments.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder) / "var")
        if given.grammar:
            run(site, "import_generator", str(given.grammar.resolve()), "--world", WORLD)
        else:
            run(site, "shell", "-c", STARTER)
        run(site, "import_competition", str(COMPETITION), "--world", WORLD)
        asked = (
            "--file",
            str(given.file.resolve()),
            "--world",
            WORLD,
            "--parser",
            "grammar-oracle",
        )
        seconds = [run(site, "parse", *asked, "--json") for _ in range(given.times)]
    best = min(seconds)
    verdict = "held" if best <= MOST_SECONDS else "MISSED"
    print(
        f"{best:.1f} s of processor time (up to {max(seconds):.1f} s)  {given.file.name}   "
        f"(bound {MOST_SECONDS:g} s: {verdict})"
    )


if __name__ == "__main__":
    main()
