"""Run the web server and the workers side by side, and stop them together."""

from __future__ import annotations

import contextlib
import ctypes
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from types import FrameType

from gpsr_site.__main__ import command_line

# A worker stops within 5 s of being asked (docs/design/architecture.md); whoever is later than this is killed.
PATIENCE_SECONDS = 7.0
# A child that had worked for a while is started again at once, one that ends soon after its start later.
SETTLED_SECONDS = 10.0
RESTART_PAUSE_SECONDS = 3.0
# Linux tells a child of its parent's end, also of a SIGKILL. (Loaded now: between fork and exec little is safe.)
LIBC = ctypes.CDLL(None) if sys.platform == "linux" else None
PR_SET_PDEATHSIG = 1

PARSE_SERVER = command_line("parse_server")


class Supervisor:
    """Child processes by name, each in its own process group.

    A child that ends is started again; ``SIGINT`` or ``SIGTERM`` ends them all. Where this
    process is killed, Linux ends them.

    Args:
        later: the commands of children that are not started before ``is_time``.
        log: the file to which the children write, written anew; None for the output of this process.
    """

    def __init__(
        self,
        commands: Mapping[str, Sequence[str]],
        say: Callable[[str], object],
        later: Mapping[str, Sequence[str]] | None = None,
        is_time: Callable[[], bool] = lambda: True,
        log: Path | None = None,
    ) -> None:
        self.commands = {**commands, **(later or {})}
        self.say = say
        self.later = list(later or {})
        self.is_time = is_time
        self.output = log.open("wb") if log else None
        self.children: dict[str, subprocess.Popen[bytes]] = {}
        self.started_at: dict[str, float] = {}
        self.restart_at: dict[str, float] = {}
        self.is_stopping = False

    def start(self) -> None:
        for signal_number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(signal_number, self._ask_to_stop)
        for name in self.commands:
            if name not in self.later:
                self._start_child(name)

    def watch(self) -> None:
        """Keep the children running until a signal comes, then stop them."""
        while not self.is_stopping:
            while self.later and self.is_time():
                self._start_child(self.later.pop(0))
            self._restart_the_ended()
            time.sleep(0.2)
        self.stop()

    def stop(self) -> None:
        """Ask every child to stop; kill the process groups of those that have not in time."""
        for child in self.children.values():
            if child.poll() is None:
                child.terminate()
        deadline = time.monotonic() + PATIENCE_SECONDS
        for child in self.children.values():
            with contextlib.suppress(subprocess.TimeoutExpired):
                child.wait(max(0.0, deadline - time.monotonic()))
            _kill_group(child.pid)
            child.wait()

    def _start_child(self, name: str) -> None:
        self.started_at[name] = time.monotonic()
        self.children[name] = subprocess.Popen(
            self.commands[name],
            stdout=self.output,
            stderr=self.output,
            start_new_session=True,
            preexec_fn=partial(_end_with_parent, os.getpid()) if LIBC else None,
        )

    def _restart_the_ended(self) -> None:
        for name, child in list(self.children.items()):
            if child.poll() is None:
                continue
            now = time.monotonic()
            if name not in self.restart_at:
                self.say(f"The {name} ended with status {child.returncode}; starting it again.")
                _kill_group(child.pid)
                has_settled = now - self.started_at[name] >= SETTLED_SECONDS
                self.restart_at[name] = now + (0.0 if has_settled else RESTART_PAUSE_SECONDS)
            elif now >= self.restart_at[name]:
                del self.restart_at[name]
                self._start_child(name)

    def _ask_to_stop(self, signal_number: int, frame: FrameType | None) -> None:
        self.is_stopping = True


def _end_with_parent(parent: int) -> None:
    """Ask Linux for a SIGTERM when ``parent`` ends. Called in the new child."""
    assert LIBC is not None
    LIBC.prctl(PR_SET_PDEATHSIG, signal.SIGTERM, 0, 0, 0)
    if os.getppid() != parent:
        os._exit(1)


def _kill_group(process_group: int) -> None:
    """End what is left of a child's process group; an empty group is fine."""
    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.killpg(process_group, signal.SIGKILL)


def web_server_commands(count: int) -> dict[str, list[str]]:
    """Return the commands of ``count`` web servers, by name.

    One process with threads (gpsr_site.web.server) is enough for a team: pages are short, and SQLite has
    one writer. Several share the port.
    """
    command = command_line("serve")
    if count == 1:
        return {"web server": command}
    return {f"web server {each}": [*command, "--share-port"] for each in range(1, count + 1)}


def worker_command(*queues: str) -> list[str]:
    """Return the command of a worker that serves ``queues``."""
    return command_line("work", "--queue", *queues)
