"""``quickstart`` as a person runs it: it serves, trains, and leaves nothing behind."""

from __future__ import annotations

import os
import signal
import socket
import sqlite3
import subprocess
import sys
import time
import urllib.request
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
pytestmark = pytest.mark.processes
SERVES_WITHIN = 60
STOPS_WITHIN = 10


class Installation:
    """A fresh ``var`` folder and a free port; ``start`` serves from it."""

    def __init__(self, folder: Path):
        self.folder = folder
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        given = {key: value for key, value in os.environ.items() if key != "DATABASE_URL"}
        self.environment = {**given, "GPSR_VAR_DIR": str(folder), "PORT": str(self.port)}
        self.process: subprocess.Popen[bytes] | None = None
        self.log = folder.parent / "log"

    def start(self) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "manage.py", "quickstart"],
            cwd=ROOT,
            env=self.environment,
            stdout=self.log.open("wb"),
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
        wait_until(self.announces, SERVES_WITHIN, "the address is printed")

    def announces(self) -> bool:
        assert self.process is not None and self.process.poll() is None, self.said()
        return "GPSR Workbench is at" in self.said()

    def said(self) -> str:
        return self.log.read_text(encoding="utf-8")

    def page(self, path: str) -> tuple[int, str]:
        with urllib.request.urlopen(f"http://127.0.0.1:{self.port}{path}", timeout=10) as answer:
            return answer.status, answer.read().decode()

    def count(self, query: str) -> int:
        with sqlite3.connect(self.folder / "db.sqlite3", timeout=20) as connection:
            return connection.execute(query).fetchone()[0]

    def stop(self) -> int:
        assert self.process is not None
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(timeout=STOPS_WITHIN)

    def remaining_processes(self) -> list[str]:
        """The processes that carry this installation's folder in their environment."""
        mark = f"GPSR_VAR_DIR={self.folder}".encode()
        found = []
        for process in Path("/proc").glob("[0-9]*"):
            try:
                if mark in (process / "environ").read_bytes().split(b"\0"):
                    found.append((process / "cmdline").read_text().replace("\0", " "))
            except OSError:
                continue
        return found


def wait_until(condition, seconds: float, what: str) -> None:
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline, f"{what}: not within {seconds} s"
        time.sleep(0.1)


@pytest.fixture
def installation(tmp_path):
    folder = tmp_path / "var"
    folder.mkdir()
    made = Installation(folder)
    yield made
    if made.process is not None and made.process.poll() is None:
        made.stop()


@pytest.mark.skipif(not Path("/proc/self/environ").exists(), reason="reads /proc")
def test_it_serves_trains_and_stops_twice_over(installation):
    installation.start()
    assert "password: " in installation.said()
    assert installation.page("/healthz")[0] == 200
    assert "Log in" in installation.page("/")[1]
    finished = "SELECT count(*) FROM parser_service_trainingrun WHERE status = 'succeeded'"
    wait_until(lambda: installation.count(finished) >= 2, 60, "the quick parsers are trained")
    assert installation.stop() == 0
    assert installation.remaining_processes() == []

    examples = installation.count("SELECT count(*) FROM annotations_example")
    runs = installation.count("SELECT count(*) FROM parser_service_trainingrun")
    installation.start()
    assert "password: " not in installation.said()
    assert installation.count("SELECT count(*) FROM annotations_example") == examples
    assert installation.count("SELECT count(*) FROM parser_service_trainingrun") == runs
    assert installation.stop() == 0
    assert installation.remaining_processes() == []


def test_a_port_that_is_taken_is_refused_with_another_way(installation):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", installation.port))
        taken.listen()
        answer = subprocess.run(
            [sys.executable, "manage.py", "quickstart"],
            cwd=ROOT,
            env=installation.environment,
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
    assert answer.returncode == 1
    assert f"PORT={installation.port + 1} make run" in answer.stderr
    assert "Traceback" not in answer.stderr
