"""Trainings of a benchmark side by side, each in a process of its own."""

from __future__ import annotations

import os
import pickle
import signal
import threading
from collections.abc import Generator, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing import get_context, parent_process, resource_tracker
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess
from typing import TYPE_CHECKING

import django

if TYPE_CHECKING:  # A new process imports this file before Django is ready for models.
    from parser_service.benchmarking import Cell, Group


@dataclass(slots=True)
class Child:
    """A process that measures ``group``; ``answered`` of its jobs have their cell or sentence."""

    process: SpawnProcess
    group: Group
    answered: int = 0


def measured_in_parallel(
    groups: Iterable[Group], at_once: int
) -> Generator[Cell | str, None, None]:
    """What ``Group.measured`` gives for all ``groups``, as it comes; groups are taken when their
    turn is. A process that ends too early gives a sentence for each of its jobs without an answer.
    Closing the generator ends the processes.
    """
    waiting = iter(groups)
    running: dict[Connection, Child] = {}
    try:
        while True:
            while len(running) < at_once and (group := next(waiting, None)):
                _start(group, running)
            if not running:
                return
            for answers in wait(list(running)):
                child = running[answers]
                try:
                    answer = answers.recv()
                except (EOFError, OSError):  # OSError where the process ended within a message.
                    del running[answers]
                    child.process.join()
                    yield from _unanswered(child)
                else:
                    child.answered += 1
                    yield answer
    finally:
        for child in running.values():
            child.process.kill()
            child.process.join()


def _start(group: Group, running: dict[Connection, Child]) -> None:
    context = get_context("spawn")
    answers, answering = context.Pipe(duplex=False)
    # Pickled here and unpickled once Django is ready there: its classes import models.
    process = context.Process(target=_measure, args=(pickle.dumps(group), answering))
    with _interrupts_blocked():
        process.start()
        running[answers] = Child(process, group)
    answering.close()  # So that the end of the process is the end of its answers.


@contextmanager
def _interrupts_blocked() -> Iterator[None]:
    """Lets a process that is started inside never see the Ctrl-C that its parent ends it for."""
    resource_tracker.ensure_running()  # Its own start, within that of the first, would unblock.
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _measure(pickled: bytes, answering: Connection) -> None:
    """Measures a group in a new process. Settings come from the environment, as the parent's do."""
    threading.Thread(target=_end_with_parent, daemon=True).start()
    django.setup()
    group: Group = pickle.loads(pickled)
    # Not every parser tests on the threads that it trains on, and torch takes all cores by itself.
    if threads := dict(group.jobs[0].configuration).get("threads"):
        os.environ["OMP_NUM_THREADS"] = str(threads)
    for answer in group.measured():
        answering.send(answer)


def _end_with_parent() -> None:
    """Where the parent is killed, nobody is left to end this process or to read its cells."""
    if parent := parent_process():
        parent.join()
        os._exit(1)


def _unanswered(child: Child) -> Iterator[str]:
    code = child.process.exitcode or 0
    how = f"was killed by {signal.Signals(-code).name}" if code < 0 else f"ended with status {code}"
    why = (
        f"the process that measured {child.group} {how}. Measure again what is missing, with a "
        "smaller --jobs where memory ran short."
    )
    for job in child.group.jobs[child.answered :]:
        yield job.refused(why)
