"""What training costs: wall time and peak memory, each training in a process of its own.

    GPSR_SHARED_DATA=… .venv/bin/python -m benchmarks.parsing.training --parsers knn,seq2seq

Each parser is trained on the published corpus by ``manage.py benchmark`` on a fresh SQLite database,
under every protocol that it supports. The seconds are those of the training alone; the memory is that of the
whole process, which also reads the pairs and scores the validation part. The bounds are for the default
configuration on two processor cores.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from itertools import product
from pathlib import Path

from benchmarks.fresh_site import DATA, WORLD, Site
from parser_service.parsers.registry import entry, parsers

MOST_SECONDS = 360.0
MOST_BYTES = 2 * 1024**3


def verdict(measured: float, bound: float) -> str:
    return "held" if measured <= bound else "MISSED"


def measure(site: Site, cells: Path, parser: str, protocol: str, setting: str, by: str) -> bool:
    """Train once and print a line; return whether there was anything to measure."""
    spent = site.run(
        *("benchmark", str(DATA / "walker2019"), "--world", WORLD, "--json", str(cells)),
        *("--parsers", parser, "--protocols", protocol, "--train-test", setting, "--criteria", by),
    )
    name = f"{parser}, {protocol}, {setting} by {by}"
    if spent.status:
        print(f"        –         –  {name}: {spent.errors.strip()}", flush=True)
        return False
    seconds = json.loads(cells.read_text(encoding="utf-8"))[-1]["seconds_train"]
    print(
        f"{seconds:7.1f} s  {spent.peak / 1024**2:6.0f} MB  {name}   "
        f"(bound {MOST_SECONDS:g} s: {verdict(seconds, MOST_SECONDS)}; "
        f"{MOST_BYTES / 1024**2:g} MB: {verdict(spent.peak, MOST_BYTES)})",
        flush=True,
    )
    return True


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    arguments.add_argument("--parsers", default=",".join(parsers()), metavar="A,B")
    arguments.add_argument("--train-test", default="gen-gen,para-para,gen+para-para", metavar="A,B")
    arguments.add_argument("--criteria", default="command", metavar="A,B")
    given = arguments.parse_args()
    try:
        entries = {name: entry(name) for name in given.parsers.split(",")}
    except ValueError as error:
        sys.exit(str(error))
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder) / "var")
        site.import_world()
        measured = [
            measure(site, Path(folder) / "cells.json", name, protocol, setting, by)
            for name, each in entries.items()
            for protocol, setting, by in product(
                each.protocols, given.train_test.split(","), given.criteria.split(",")
            )
        ]
    if not all(measured):
        sys.exit(1)


if __name__ == "__main__":
    main()
