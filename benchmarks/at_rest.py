"""What an installation that nobody uses takes: memory and processor time of all its processes.

    .venv/bin/python -m benchmarks.at_rest PID [--seconds 60]

``PID`` is that of ``manage.py quickstart``, which ``make run`` starts. Memory is the proportional set size: what
processes share is divided between them. For Linux.
"""

from __future__ import annotations

import argparse
import os
import time
from pathlib import Path

TICKS = os.sysconf("SC_CLK_TCK")


def processes_below(root: int) -> list[int]:
    """Return ``root`` and all processes that descend from it."""
    parents = {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        parents[int(stat.parent.name)] = int(stat.read_text().rpartition(")")[2].split()[1])
    found = [root]
    for parent in found:
        found.extend(child for child, its_parent in parents.items() if its_parent == parent)
    return found


def seconds_of(process: int) -> float:
    """Return the processor time of a process so far, user and system, in seconds."""
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / TICKS


def megabytes_of(process: int) -> float:
    """Return the proportional set size of a process, in units of 2**20 bytes."""
    lines = Path(f"/proc/{process}/smaps_rollup").read_text().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("Pss:")) / 1024


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("pid", type=int)
    parser.add_argument("--seconds", type=float, default=60.0)
    given = parser.parse_args()
    before = {process: seconds_of(process) for process in processes_below(given.pid)}
    time.sleep(given.seconds)
    total_memory = total_share = 0.0
    for process, spent in before.items():
        share = 100 * (seconds_of(process) - spent) / given.seconds
        memory = megabytes_of(process)
        arguments = Path(f"/proc/{process}/cmdline").read_text().split("\0")
        print(f"{memory:6.0f} MB {share:5.2f} %  {' '.join(arguments[1:])}")
        total_memory, total_share = total_memory + memory, total_share + share
    print(f"{total_memory:6.0f} MB {total_share:5.2f} % of a core, {len(before)} processes")


if __name__ == "__main__":
    main()
