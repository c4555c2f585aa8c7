"""Workers as real processes that share the test's database, and waiting for what they do."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

from django.conf import settings as site
from django.db import connection

from parser_service.models import TrainingRun
from tests.waiting import PATIENCE_SECONDS, wait_for

ROOT = Path(__file__).resolve().parents[2]
TEMPO = 10.0


def database_url(port: int | None = None) -> str:
    """How another process names the database of this test, reached by ``port`` where one is given."""
    given = connection.settings_dict
    if connection.vendor == "sqlite":
        return f"sqlite:///{given['NAME']}"
    host, port = given["HOST"] or "127.0.0.1", port or given["PORT"] or 5432
    return f"postgres://{given['USER']}:{given['PASSWORD']}@{host}:{port}/{given['NAME']}"


class RunningWorker:
    """One ``manage.py work`` in a process group of its own, at ``tempo`` times the usual tempo.

    It serves ``queues``, or all where none is named.
    """

    def __init__(
        self, log: Path, *queues: str, database_port: int | None = None, tempo: float = TEMPO
    ):
        environment = {
            **os.environ,
            "DATABASE_URL": database_url(database_port),
            "GPSR_VAR_DIR": str(site.VAR_DIR),
            "GPSR_WORK_TEMPO": str(tempo),
        }
        self.log = log
        self.process = subprocess.Popen(
            [sys.executable, "manage.py", "work", *(["--queue", *queues] if queues else [])],
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

    def pause(self) -> None:
        """Stop parent and children where they are, until SIGCONT; return once none of their threads runs."""
        self.signal_all(signal.SIGSTOP)
        # The signal is on its way: a thread finishes its system call first, which may take a lock.
        for process in (self.pid, *self.children()):
            wait_for(lambda p=process: states(p) <= {"T", "Z"}, f"process {process} is paused")

    def stop(self) -> int:
        """Send SIGTERM and return the exit status once the process is gone."""
        self.process.terminate()
        return self.process.wait(PATIENCE_SECONDS)

    def remove(self) -> None:
        for number in (signal.SIGCONT, signal.SIGKILL):
            try:
                os.killpg(self.pid, number)
            except ProcessLookupError:
                return
        self.process.wait()


def states(process: int) -> set[str]:
    """What the threads of ``process`` do, in Linux's letters: R runs, S sleeps, T is stopped, Z has ended.

    Empty for a process that is gone, and where there is no /proc.
    """
    found = set()
    for thread in Path(f"/proc/{process}/task").glob("*/stat"):
        with suppress(OSError):
            found.add(thread.read_text(encoding="ascii").rpartition(")")[2].split()[0])
    return found


def wait_for_status(run: TrainingRun, status: str) -> None:
    def reached() -> bool:
        run.refresh_from_db()
        return run.status == status

    wait_for(reached, f"run {run.pk} is {status}")


def wait_for_epochs(run: TrainingRun, number: int) -> None:
    """Wait until the run has a checkpoint of epoch ``number`` or a later one."""
    wait_for(
        lambda: run.checkpoints.filter(epoch__gte=number).exists(),
        f"epoch {number} of run {run.pk}",
    )
