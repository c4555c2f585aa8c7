"""``quickstart`` as a person runs it: it serves, trains, and leaves nothing behind."""

from __future__ import annotations

import os
import pty
import random
import signal
import socket
import sqlite3
import subprocess
import sys
import urllib.request
from contextlib import suppress
from pathlib import Path

import pytest

from tests.migrated import copy_installation
from tests.waiting import PATIENCE_SECONDS, wait_for

ROOT = Path(__file__).resolve().parents[2]
pytestmark = [pytest.mark.processes, pytest.mark.services]
# Below those that systems give to whoever asks for any free port.
PORTS = range(15_000, 30_000)


class Installation:
    """A fresh ``var`` folder and a free port; ``start`` serves from it."""

    def __init__(self, folder: Path):
        self.folder = folder
        self.port = free_port()
        elsewhere = ("DATABASE_URL", "PARSER_PORT")
        given = {key: value for key, value in os.environ.items() if key not in elsewhere}
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
        wait_for(self.announces, "the address is printed")

    def start_on_a_terminal(self) -> str:
        """Start on a terminal. Return what stands there once the workers are at work."""
        terminal, end = pty.openpty()
        self.process = subprocess.Popen(
            [sys.executable, "manage.py", "quickstart"],
            cwd=ROOT,
            env=self.environment,
            stdin=end,
            stdout=end,
            stderr=end,
            start_new_session=True,
        )
        os.close(end)
        written = self.folder / "quickstart.log"
        wait_for(lambda: written.exists() and b"ready" in written.read_bytes(), "workers are ready")
        self.process.send_signal(signal.SIGTERM)
        said = b""
        with suppress(OSError):  # the end of a terminal
            while piece := os.read(terminal, 10_000):
                said += piece
        os.close(terminal)
        return said.decode()

    def announces(self) -> bool:
        assert self.process is not None and self.process.poll() is None, self.said()
        return "GPSR Workbench is at" in self.said()

    def said(self) -> str:
        return self.log.read_text(encoding="utf-8")

    def page(self, path: str) -> tuple[int, str]:
        with urllib.request.urlopen(
            f"http://127.0.0.1:{self.port}{path}", timeout=PATIENCE_SECONDS
        ) as answer:
            return answer.status, answer.read().decode()

    def count(self, query: str) -> int:
        with sqlite3.connect(self.folder / "db.sqlite3", timeout=PATIENCE_SECONDS) as connection:
            return connection.execute(query).fetchone()[0]

    def stop(self) -> int:
        assert self.process is not None
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(PATIENCE_SECONDS)

    def remaining_processes(self) -> list[str]:
        """The processes that carry this installation's folder in their environment."""
        mark = f"GPSR_VAR_DIR={self.folder}".encode()
        processes = []
        for process in Path("/proc").glob("[0-9]*"):
            try:
                if mark in (process / "environ").read_bytes().split(b"\0"):
                    processes.append((process / "cmdline").read_text().replace("\0", " "))
            except OSError:
                continue
        return processes


def free_port() -> int:
    while True:
        with socket.socket() as probe, suppress(OSError):
            port = random.choice(PORTS)
            probe.bind(("127.0.0.1", port))
            return port


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
    wait_for(lambda: installation.count(finished) >= 2, "the quick parsers are trained")
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


def test_a_terminal_ends_with_the_address_and_the_password(installation, migrated_database):
    copy_installation(migrated_database, installation.folder)
    *_, address, password, change, stopped = installation.start_on_a_terminal().splitlines()
    assert f":{installation.port}/" in address and "password: " in password
    assert "changepassword" in change and stopped == "Stopped."


@pytest.mark.skipif(not Path("/proc/self/environ").exists(), reason="Linux ends them")
def test_what_it_started_ends_with_it_even_when_it_is_killed(installation, migrated_database):
    copy_installation(migrated_database, installation.folder)
    installation.start()
    wait_for(lambda: len(installation.remaining_processes()) >= 4, "all are started")
    installation.process.kill()
    installation.process.wait()
    wait_for(lambda: installation.remaining_processes() == [], "all processes are gone")


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
            timeout=PATIENCE_SECONDS,
            check=False,
        )
    assert answer.returncode == 1
    assert f"PORT={installation.port + 1} make run" in answer.stderr
    assert "Traceback" not in answer.stderr
