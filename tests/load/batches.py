"""Ten batches at once, and how long pages and ``/healthz`` take meanwhile.

    python -m tests.load.batches [--batches 10] [--lines 5000] [--seconds 60] [--parser linear]

Trains ``--parser`` in the starter world of a fresh SQLite database, promotes it, and starts ``manage.py serve`` and
``manage.py parse_server`` with their defaults, as ``make run`` has them. Ten clients send batches of JSON lines,
one after the other, and try again when the server says so. Others ask for pages and for ``/healthz`` five times a
second, first alone for half of ``--seconds``, then beside the batches. Exits with 1 where an answer took longer than
a second or was an error, or where a batch came back with a line less.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
import threading
import time
from collections import Counter, defaultdict
from http.client import HTTPConnection
from pathlib import Path

from benchmarks.parsing.parse_command import WORLD
from benchmarks.parsing.serving import free_port, make_site, promote_run
from tests.load.work_queue import say, wait_for

MOST_SECONDS = 1.0
PAUSE = 0.2
PAGES = (f"/w/{WORLD}/", f"/w/{WORLD}/commands/", f"/w/{WORLD}/utterances/")


class Load:
    """Asks until it is stopped. ``times`` are the seconds of each answer by what was asked for."""

    def __init__(self, port: int, session: str, token: str) -> None:
        self.port, self.session, self.token = port, session, token
        self.times: dict[str, list[float]] = defaultdict(list)
        self.batches: Counter[int] = Counter()  # by status
        self.problems: list[str] = []
        self.is_over = threading.Event()

    def look(self, name: str, path: str) -> None:
        """Ask for ``path`` at a steady rate, each time by a connection of its own as a monitor does."""
        headers = {"Cookie": f"sessionid={self.session}"}
        while not self.is_over.wait(PAUSE):
            began = time.perf_counter()
            connection = HTTPConnection("127.0.0.1", self.port, timeout=60)
            connection.request("GET", path, headers=headers)
            answer = connection.getresponse()
            answer.read()
            connection.close()
            self.times[name].append(time.perf_counter() - began)
            if answer.status != 200:
                self.problems.append(f"{path}: {answer.status}")

    def send(self, number: int, count: int) -> None:
        """Send batches of ``count`` lines, each utterance another one."""
        texts = (
            f"please take the apple number {number * count + each} to the kitchen table"
            for each in range(count)
        )
        lines = "\n".join(json.dumps({"utterance": text}) for text in texts).encode()
        headers = {"Authorization": f"Bearer {self.token}", "Content-Type": "application/jsonl"}
        while not self.is_over.is_set():
            connection = HTTPConnection("127.0.0.1", self.port, timeout=300)
            connection.request("POST", f"/api/v1/worlds/{WORLD}/parse/", lines, headers)
            answer = connection.getresponse()
            answered = answer.read().count(b"\n")
            connection.close()
            self.batches[answer.status] += 1
            if answer.status == 503:
                self.is_over.wait(float(answer.getheader("Retry-After", "1")))
            elif answer.status != 200 or answered != count:
                self.problems.append(f"batch: {answer.status}, {answered} of {count} lines")


def sign_in() -> tuple[str, str]:
    """Return the session and a token of a new person in the world."""
    from django.test import Client

    from annotations.models import ApiToken, Membership, User, World

    user = User.objects.create_user("nora")
    Membership.objects.create(world=World.objects.get(name=WORLD), user=user, role="annotator")
    client = Client()
    client.force_login(user)
    return client.cookies["sessionid"].value, ApiToken.issue(user, "batches")[1]


def measure(given: argparse.Namespace, port: int) -> bool:
    """Return whether all was answered in time."""
    load = Load(port, *sign_in())
    looking = [("healthz", "/healthz"), *(("pages", path) for path in PAGES)]
    threads = [threading.Thread(target=load.look, args=each) for each in looking]
    threads += [
        threading.Thread(target=load.send, args=(number, given.lines))
        for number in range(given.batches)
    ]
    for thread in threads[: len(looking)]:
        thread.start()
    time.sleep(given.seconds / 2)
    alone = {name: list(times) for name, times in load.times.items()}
    load.times.clear()
    for thread in threads[len(looking) :]:
        thread.start()
    time.sleep(given.seconds)
    load.is_over.set()
    for thread in threads:
        thread.join()
    for name in sorted(alone):
        say(f"{name} alone", alone[name])
        say(f"{name} beside {given.batches} batches", load.times[name])
    print(f"batches by status: {dict(load.batches)}; problems: {load.problems[:5] or 'none'}")
    slowest = max(max(times) for times in load.times.values())
    return slowest <= MOST_SECONDS and not load.problems and load.batches[200] > 0


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--batches", type=int, default=10, help="clients that send batches")
    parser.add_argument("--lines", type=int, default=5000, help="of each batch")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--parser", default="linear")
    given = parser.parse_args()
    port = free_port()
    os.environ.update(PORT=str(port), PARSER_PORT=str(free_port()))
    with tempfile.TemporaryDirectory(prefix="gpsr-load-") as folder:
        site = make_site(Path(folder), given.parser)
        site.run("collectstatic", "--no-input")
        site.enter()
        from gpsr_site.processes import PARSE_SERVER, Supervisor, web_server_commands

        promote_run()
        supervisor = Supervisor({**web_server_commands(1), "parse server": PARSE_SERVER}, print)
        supervisor.start()
        watching = threading.Thread(target=supervisor.watch)
        watching.start()
        try:
            wait_for(port, supervisor.children["web server"])
            is_good = measure(given, port)
        finally:
            supervisor.is_stopping = True
            watching.join()
    sys.exit(not is_good)


if __name__ == "__main__":
    main()
