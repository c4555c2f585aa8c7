"""Workers as real processes that share the test's database, and waiting for what they do."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from django.conf import settings as site
from django.db import connection

from parser_service.models import TrainingRun

ROOT = Path(__file__).resolve().parents[2]
TEMPO = 10.0


def database_url() -> str:
    """How another process names the database of this test."""
    given = connection.settings_dict
    if connection.vendor == "sqlite":
        return f"sqlite:///{given['NAME']}"
    host, port = given["HOST"] or "127.0.0.1", given["PORT"] or 5432
    return f"postgres://{given['USER']}:{given['PASSWORD']}@{host}:{port}/{given['NAME']}"


class RunningWorker:
    """One ``manage.py work`` in a process group of its own, at ten times the usual tempo."""

    def __init__(self, log: Path):
        environment = {
            **os.environ,
            "DATABASE_URL": database_url(),
            "GPSR_VAR_DIR": str(site.VAR_DIR),
            "GPSR_WORK_TEMPO": str(TEMPO),
        }
        self.log = log
        self.process = subprocess.Popen(
            [sys.executable, "manage.py", "work"],
            cwd=ROOT,
            env=environment,
            stdout=log.open("ab"),
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )

    @property
    def pid(self) -> int:
        return self.process.pid

    def children(self) -> list[int]:
        """The processes that train, idle ones included."""
        listed = subprocess.run(
            ["pgrep", "-P", str(self.pid)], capture_output=True, text=True, check=False
        )
        return [int(number) for number in listed.stdout.split()]

    def kill_child(self) -> None:
        for child in self.children():
            os.kill(child, signal.SIGKILL)

    def kill_parent(self) -> None:
        self.process.kill()
        self.process.wait()

    def signal_all(self, number: int) -> None:
        """Sends a signal to parent and children."""
        os.killpg(self.pid, number)

    def stop(self) -> float:
        """SIGTERM; the seconds until the process is gone."""
        began = time.monotonic()
        self.process.terminate()
        self.process.wait(timeout=10)
        return time.monotonic() - began

    def remove(self) -> None:
        for number in (signal.SIGCONT, signal.SIGKILL):
            try:
                os.killpg(self.pid, number)
            except ProcessLookupError:
                return
        self.process.wait()


def wait_for(condition: Callable[[], bool], seconds: float, what: str) -> float:
    """Waits until ``condition``; how long it took. Fails, saying ``what``, where it takes longer."""
    began = time.monotonic()
    while not condition():
        if time.monotonic() - began > seconds:
            pytest.fail(f"{what}: not within {seconds} seconds")
        time.sleep(0.02)
    return time.monotonic() - began


def wait_for_status(run: TrainingRun, status: str, seconds: float) -> float:
    def reached() -> bool:
        run.refresh_from_db()
        return run.status == status

    return wait_for(reached, seconds, f"run {run.pk} is {status}")


def wait_for_epochs(run: TrainingRun, number: int, seconds: float = 60) -> float:
    """Waits until the run has a checkpoint of epoch ``number`` or a later one."""
    return wait_for(
        lambda: run.checkpoints.filter(epoch__gte=number).exists(),
        seconds,
        f"epoch {number} of run {run.pk}",
    )
