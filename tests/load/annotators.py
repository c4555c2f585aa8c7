"""What eight annotators do in the time of one, and how long saves take meanwhile.

    python -m tests.load.annotators                       # one person, then eight, on SQLite
    python -m tests.load.annotators --database postgres://postgres@127.0.0.1:5432/gpsr_load
    python -m tests.load.annotators --people 1 8 30 --seconds 60 --processes 2
    python -m tests.load.annotators --people 8 --upload 5000

Starts ``manage.py serve`` with its defaults on a database of its own (SQLite in a temporary folder unless
one is named, which has to be empty). Everybody labels the items of the queue over REST, one after the
other, as fast as the server answers. Says labels a second, percentiles of saves and of next items, and
the processor time of the server for each label, which other programs on the machine change little.

With ``--upload`` the world has a trained parser and a worker for short work, and so many utterances are
posted at once; the people label while the worker makes proposals for them, until it has ended, or for four
minutes.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import subprocess
import sys
import tempfile
import time
import urllib.request
from collections import defaultdict
from contextlib import ExitStack, contextmanager
from pathlib import Path

from tests.load.work_queue import ROOT, Caller, fill, say, server

MOST_A_SECOND = 60  # labels of all together: so many items are made
PATIENCE_SECONDS = 240  # for the worker, beside an upload


async def label(callers: list[Caller], is_over) -> None:
    """Let everybody label until it is over."""

    async def one(caller: Caller) -> None:
        while not is_over() and await caller.next() is not None:
            await caller.save()

    await asyncio.gather(*(one(caller) for caller in callers))


def cpu_seconds(root: int) -> float:
    """Processor time of a process and all below it, in seconds."""
    parents, used = {}, {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        key = int(stat.parent.name)
        parents[key], used[key] = int(fields[1]), sum(map(int, fields[11:15]))

    def is_below(key: int) -> bool:
        return key == root or (key in parents and is_below(parents[key]))

    return sum(used[key] for key in used if is_below(key)) / os.sysconf("SC_CLK_TCK")


def train() -> None:
    """Give the world a nearest neighbour that has been trained, as a newcomer's world has one."""
    from annotations import background
    from annotations.background.kinds import carry_out
    from annotations.exchange.starter_world import load_starter_world
    from annotations.models import World
    from parser_service.models import TrainingRun
    from parser_service.runs.first_runs import request_first_runs

    request_first_runs(load_starter_world(lambda _: None))
    while run := background.claim("load", "quick", TrainingRun):
        carry_out(run)
    World.objects.filter(name="load").delete()
    World.objects.filter(name="household").update(name="load")


@contextmanager
def worker():
    command = [sys.executable, "manage.py", "work", "--queue", "quick"]
    process = subprocess.Popen(
        command, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.STDOUT
    )
    try:
        yield
    finally:
        process.terminate()
        process.wait(30)


def post_utterances(port: int, key: str, count: int) -> float:
    """Post so many different utterances at once. Returns how long the answer took, in seconds."""
    texts = [
        f"would you please bring me thing {number} from the kitchen" for number in range(count)
    ]
    request = urllib.request.Request(
        f"http://127.0.0.1:{port}/api/v1/worlds/load/utterances/",
        json.dumps({"texts": texts}).encode(),
        {"Authorization": f"Bearer {key}", "Content-Type": "application/json"},
    )
    began = time.perf_counter()
    with urllib.request.urlopen(request, timeout=120) as answer:
        answer.read()
    return time.perf_counter() - began


def is_proposing() -> bool:
    from django.db import connection

    from annotations.models import Job

    connection.close()
    return Job.objects.active().filter(kind="propose").exists()


def measure(people: int, seconds: float, upload: int) -> None:
    """Print what ``people`` do in ``seconds``, or while the utterances of an upload are looked at."""
    with ExitStack() as stack:
        keys = fill(people, people + int(MOST_A_SECOND * seconds), is_new=not upload)
        times: dict[str, list[float]] = defaultdict(list)
        process, port = stack.enter_context(server())
        callers = [Caller(port, key, times) for key in keys]
        runner = stack.enter_context(asyncio.Runner())
        runner.run(label(callers, lambda: len(times["save"]) >= 2 * people))  # all is loaded then
        times.clear()
        if upload:
            stack.enter_context(worker())
            print(
                f"{upload} utterances were posted in {post_utterances(port, keys[0], upload):.1f} s"
            )
        before, began = cpu_seconds(process.pid), time.perf_counter()
        looked = [began, True]

        def is_over() -> bool:
            now = time.perf_counter()
            if not upload:
                return now - began >= seconds
            if now - looked[0] > 1:
                looked[:] = now, is_proposing()
            return not looked[1] or now - began > PATIENCE_SECONDS

        runner.run(label(callers, is_over))
        passed, used = time.perf_counter() - began, cpu_seconds(process.pid) - before
    if upload and looked[1]:
        print(f"The worker has not ended within {PATIENCE_SECONDS} s.")
    saves = times["save"]
    print(
        f"{people} people: {len(saves)} labels in {passed:.0f} s, {len(saves) / passed:.1f} a second, "
        f"{1000 * used / len(saves):.1f} ms of the server's processor time each"
    )
    say("  saves", saves)
    say("  next items", times["next"])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--people", type=int, nargs="+", default=[1, 8])
    parser.add_argument("--seconds", type=float, default=30.0)
    parser.add_argument(
        "--processes", type=int, help="WEB_PROCESSES; its default where it is left out"
    )
    parser.add_argument(
        "--upload", type=int, default=0, help="utterances to post at once meanwhile"
    )
    parser.add_argument("--database", default="", help="a URL; its database has to be empty")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="gpsr-load-") as folder:
        os.environ.update(GPSR_VAR_DIR=folder, DJANGO_SETTINGS_MODULE="gpsr_site.settings")
        # Between two requests the people look whether the job has ended; they may wait for that.
        os.environ["DJANGO_ALLOW_ASYNC_UNSAFE"] = "true"
        os.environ.pop("DATABASE_URL", None)
        if arguments.database:
            os.environ["DATABASE_URL"] = arguments.database
        if arguments.processes:
            os.environ["WEB_PROCESSES"] = str(arguments.processes)
        subprocess.run([sys.executable, "manage.py", "migrate", "-v0"], cwd=ROOT, check=True)
        import django

        django.setup()
        for people in arguments.people:
            if arguments.upload:
                train()
            measure(people, arguments.seconds, arguments.upload)


if __name__ == "__main__":
    main()
