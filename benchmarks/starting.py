"""What people wait for first: a command, a new database, a shipped world, and the first page.

    .venv/bin/python -m benchmarks.starting [--rounds 5] [--port 8231]

Prints the median seconds of processor time, user and system, and of wall time. Each round has a new SQLite database in
a folder of its own. For Linux.
"""

from __future__ import annotations

import argparse
import os
import signal
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from collections import defaultdict
from contextlib import suppress
from pathlib import Path
from statistics import median

from benchmarks.at_rest import processes_below, seconds_of
from benchmarks.fresh_site import ROOT, Site

COMMANDS = {
    "manage.py help": ["help"],
    "manage.py load_world competition": ["load_world", "competition", "--world", "robocup"],
}


def first_page(folder: Path, port: int) -> tuple[float, float]:
    """Return the processor time of all processes of ``quickstart`` until it shows a page, and the wall time."""
    began = time.perf_counter()
    site = subprocess.Popen(
        [sys.executable, "manage.py", "quickstart"],
        cwd=ROOT,
        env={**os.environ, "GPSR_VAR_DIR": str(folder), "PORT": str(port)},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        while site.poll() is None:
            with suppress(urllib.error.URLError, ConnectionError):
                urllib.request.urlopen(f"http://127.0.0.1:{port}/login/", timeout=60).close()
                wall = time.perf_counter() - began
                return sum(map(seconds_of, processes_below(site.pid))), wall
            time.sleep(0.1)
        sys.exit("quickstart has ended")
    finally:
        site.send_signal(signal.SIGTERM)
        site.wait()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--port", type=int, default=8231)
    given = parser.parse_args()
    spent: defaultdict[str, list[tuple[float, float]]] = defaultdict(list)
    for _ in range(given.rounds):
        with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as other:
            site = Site(Path(folder))
            spent["manage.py migrate"].append((site.migrated.processor, site.migrated.wall))
            for name, arguments in COMMANDS.items():
                one = site.run(*arguments)
                if one.status:
                    sys.exit(one.errors)
                spent[name].append((one.processor, one.wall))
            spent["quickstart to the first page"].append(first_page(Path(other), given.port))
    print("| | processor time | wall time |\n| --- | --- | --- |")
    for name, rounds in spent.items():
        processor, wall = (median(each) for each in zip(*rounds, strict=True))
        print(f"| {name} | {processor:.2f} s | {wall:.2f} s |")


if __name__ == "__main__":
    main()
