"""Many annotators at once: everybody holds one item of the queue and labels are saved at a steady rate.

    python -m tests.load.work_queue --people 30 --rate 1 --seconds 60
    python -m tests.load.work_queue --people 200 --database postgres://postgres@127.0.0.1:5432/gpsr_load
    WEB_PROCESSES=2 python -m tests.load.work_queue --people 200 --rate 200 --database postgres://…

Starts ``manage.py serve`` on a database of its own (SQLite in a temporary folder unless one is named),
gives every person an item (all at once, or over ``--arrive`` seconds), then saves ``--rate`` labels a
second in total, each followed by a request for the next item, all over the REST API. Says how long each
took, how much processor time the server needed (which other programs on the machine change little), and
whether an item was given twice. Exits with 1 where it was, or where an answer was an error.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import resource
import socket
import subprocess
import sys
import tempfile
import time
from collections import Counter, defaultdict
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SETTLE_SECONDS = 10  # until several servers are all there
UNKNOWN = {"verdict": "unknown"}


class Caller:
    """One person's connection to the server, kept open."""

    def __init__(self, port: int, key: str, times: dict[str, list[float]]):
        self.port, self.key, self.times = port, key, times
        self.reader: asyncio.StreamReader | None = None
        self.writer: asyncio.StreamWriter | None = None
        self.item: dict | None = None

    async def next(self) -> int | None:
        self.item = await self.post("next", "next/", {})
        return self.item and self.item["id"]

    async def save(self) -> None:
        version = self.item["subject"]["version"]
        await self.post("save", f"{self.item['id']}/finish/", {**UNKNOWN, "version": version})

    async def post(self, what: str, path: str, values: dict) -> dict | None:
        body = json.dumps(values).encode()
        head = (
            f"POST /api/v1/worlds/load/work-items/{path} HTTP/1.1\r\nHost: 127.0.0.1\r\n"
            f"Authorization: Bearer {self.key}\r\nContent-Type: application/json\r\n"
            f"Content-Length: {len(body)}\r\n\r\n"
        )
        began = time.perf_counter()
        status, answer = await self._send(head.encode() + body)
        self.times[what].append(time.perf_counter() - began)
        if status not in (200, 204):
            raise RuntimeError(f"{path}: {status} {answer[:200]!r}")
        return json.loads(answer) if status == 200 else None

    async def _send(self, data: bytes) -> tuple[int, bytes]:
        if self.writer is None or self.writer.is_closing() or self.reader.at_eof():
            self.reader, self.writer = await asyncio.open_connection("127.0.0.1", self.port)
        self.writer.write(data)
        await self.writer.drain()
        head = (await self.reader.readuntil(b"\r\n\r\n")).decode("latin-1").lower()
        length = next(
            (int(line[15:]) for line in head.splitlines() if line.startswith("content-length:")), 0
        )
        answer = await self.reader.readexactly(length)
        if "connection: close" in head:
            self.writer.close()
        return int(head.split()[1]), answer


async def work(
    callers: list[Caller], rate: float, seconds: float, arrive: float = 0.0
) -> Counter[int]:
    """Give everybody an item, then save at ``rate``. Returns how often each item was given.

    People ask for their first item evenly over ``arrive`` seconds.
    """

    async def begin(number: int, caller: Caller) -> int | None:
        await asyncio.sleep(arrive * number / len(callers))
        return await caller.next()

    first = await asyncio.gather(*(begin(*each) for each in enumerate(callers)))
    given: Counter[int | None] = Counter(first)
    free: asyncio.Queue[Caller] = asyncio.Queue()
    for caller in callers:
        free.put_nowait(caller)

    async def step(caller: Caller) -> None:
        await caller.save()
        given[await caller.next()] += 1
        free.put_nowait(caller)

    began, steps = time.perf_counter(), []
    for number in range(int(rate * seconds)):
        await asyncio.sleep(max(0.0, began + number / rate - time.perf_counter()))
        steps.append(asyncio.create_task(step(await free.get())))
    await asyncio.gather(*steps)
    print(f"{len(steps)} saves, {len(steps) / (time.perf_counter() - began):.0f} a second")
    return given


def fill(people: int, items: int, is_new: bool = True) -> list[str]:
    """Make the world (anew, unless another is to be filled), its people and its items. Returns a token for
    each person."""
    import django

    django.setup()
    from annotations.labelling.enqueuing import WantedItem, enqueue
    from annotations.models import ApiToken, Membership, User, Utterance, World

    if is_new:
        World.objects.filter(name="load").delete()
    world, _ = World.objects.get_or_create(name="load")
    keys = []
    for number in range(people):
        user, _ = User.objects.get_or_create(username=f"person{number}")
        Membership.objects.get_or_create(world=world, user=user, role="annotator")
        keys.append(ApiToken.issue(user, "load")[1])
    Utterance.objects.bulk_create(
        Utterance(world=world, text=f"bring me thing {number}", anonymized_text="bring me thing")
        for number in range(items)
    )
    enqueue(world, "unlabelled", (WantedItem(row, "load") for row in world.utterances.all()))
    return keys


@contextmanager
def server():
    with socket.socket() as chosen:
        chosen.bind(("127.0.0.1", 0))
        port = chosen.getsockname()[1]
    environment = {**os.environ, "PORT": str(port)}
    command = [sys.executable, "manage.py", "serve"]
    process = subprocess.Popen(command, cwd=ROOT, env=environment, stdout=subprocess.DEVNULL)
    try:
        wait_for(port, process)
        time.sleep(SETTLE_SECONDS)
        yield process, port
    finally:
        process.terminate()
        process.wait(30)


def wait_for(port: int, process: subprocess.Popen) -> None:
    while process.poll() is None:
        with socket.socket() as tried:
            if tried.connect_ex(("127.0.0.1", port)) == 0:
                return
        time.sleep(0.2)
    raise SystemExit("The server did not start.")


def children_seconds() -> float:
    """Processor time of the child processes that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def say(name: str, times: list[float]) -> None:
    ordered = sorted(times)
    share = [ordered[min(len(ordered) - 1, int(len(ordered) * part))] for part in (0.5, 0.95, 0.99)]
    figures = ", ".join(
        f"{label} {1000 * each:.0f} ms"
        for label, each in zip(("p50", "p95", "p99"), share, strict=True)
    )
    print(f"{name}: {len(ordered)} requests, {figures}, longest {1000 * ordered[-1]:.0f} ms")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--people", type=int, default=30)
    parser.add_argument("--rate", type=float, default=1.0, help="labels a second, of all together")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument(
        "--arrive", type=float, default=0.0, help="seconds over which the first items are asked for"
    )
    parser.add_argument("--database", default="", help="a URL; its database has to be empty")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="gpsr-load-") as folder:
        os.environ.update(GPSR_VAR_DIR=folder, DJANGO_SETTINGS_MODULE="gpsr_site.settings")
        os.environ.pop("DATABASE_URL", None)
        if arguments.database:
            os.environ["DATABASE_URL"] = arguments.database
        subprocess.run([sys.executable, "manage.py", "migrate", "-v0"], cwd=ROOT, check=True)
        keys = fill(arguments.people, arguments.people + int(arguments.rate * arguments.seconds))
        times: dict[str, list[float]] = defaultdict(list)
        before = children_seconds()
        with server() as (_, port):
            callers = [Caller(port, key, times) for key in keys]
            given = asyncio.run(work(callers, arguments.rate, arguments.seconds, arguments.arrive))
    first, later = times["next"][: arguments.people], times["next"][arguments.people :]
    say(f"first items, asked over {arguments.arrive:g} s", first)
    say("saves", times["save"])
    say("next items", later)
    requests = sum(map(len, times.values()))
    spent = children_seconds() - before
    print(f"server: {spent:.1f} s of processor time, start included, for {requests} requests")
    twice = [item for item, count in given.items() if item is not None and count > 1]
    print(
        f"{len(given)} items given, {len(twice)} of them twice, {given[None]} times none was left"
    )
    sys.exit(bool(twice))


if __name__ == "__main__":
    main()
