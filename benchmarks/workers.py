"""How many short runs an hour one, two and four workers carry out, with PostgreSQL and RabbitMQ.

    .venv/bin/python -m benchmarks.workers --database postgres://…/empty --broker amqp://… [--runs 40] [--workers 1 2 4]

Queues runs of a parser that trains in seconds, in the starter world, and starts so many workers as processes of their
own, as several machines do. Prints the wall time from the first claim to the last run's end, runs an hour, and the
processor time of the workers for each run, their start included. Exits with 1 where a run fails, or is carried out
twice.
"""

from __future__ import annotations

import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time
from datetime import datetime
from pathlib import Path

from benchmarks.fresh_site import ROOT, Site
from benchmarks.parsing.parse_command import SPLIT, STARTER, WORLD


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    options.add_argument("--database", required=True, help="an empty database of PostgreSQL")
    options.add_argument("--broker", required=True)
    options.add_argument("--parser", default="linear")
    options.add_argument("--runs", type=int, default=40)
    options.add_argument("--workers", type=int, nargs="+", default=[1, 2, 4])
    given = options.parse_args()
    os.environ["CELERY_BROKER_URL"] = given.broker
    with tempfile.TemporaryDirectory() as folder:
        site = Site(Path(folder), given.database)
        if (made := site.run("shell", "-c", STARTER)).status:
            sys.exit(made.errors)
        site.enter()
        print(f"workers  runs an hour  wall of {given.runs}  processor time of a run")
        for turn, workers in enumerate(given.workers):
            seeds = range(turn * given.runs, (turn + 1) * given.runs)
            wall, processor = carry_out(site, given.parser, seeds, workers)
            per_hour, each = given.runs / wall * 3600, processor / given.runs
            print(f"{workers:>7} {per_hour:>13.0f} {wall:>10.1f} s {each:>10.2f} s", flush=True)


def carry_out(site: Site, parser: str, seeds: range, workers: int) -> tuple[float, float]:
    """Queue a run for each seed, let workers carry them out; return the wall time and the workers' processor time."""
    from annotations.models import Split
    from parser_service.models import TrainingRun
    from parser_service.parsers.registry import parsers
    from parser_service.runs import run_requests

    split = Split.objects.get(world__name=WORLD, name=SPLIT)
    protocol = parsers()[parser].protocols[0]
    keys = [
        run_requests.request(
            split.world,
            split=split,
            parser=parser,
            protocol=protocol,
            train_sources="gen+para",
            seed=seed,
        )[0].pk
        for seed in seeds
    ]
    runs = TrainingRun.objects.filter(pk__in=keys)
    command = [sys.executable, "manage.py", "work"]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    children = [
        subprocess.Popen(command, cwd=ROOT, env=site.environment, stderr=subprocess.DEVNULL)
        for _ in range(workers)
    ]
    try:
        while runs.filter(finished_at=None).exists():
            time.sleep(0.5)
    finally:
        for child in children:
            child.terminate()
        for child in children:
            child.wait()
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    processor = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    ended = list(runs)
    if odd := [run.pk for run in ended if run.status != "succeeded" or run.attempt != 1]:
        sys.exit(f"Runs {odd} failed or were carried out twice.")
    claimed = [run.started_at for run in ended if isinstance(run.started_at, datetime)]
    finished = [run.finished_at for run in ended if isinstance(run.finished_at, datetime)]
    return (max(finished) - min(claimed)).total_seconds(), processor


if __name__ == "__main__":
    main()
