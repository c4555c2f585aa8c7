"""Trainings of a benchmark side by side, each in a process of its own."""

from __future__ import annotations

import os
import pickle
import signal
import threading
from collections.abc import Generator, Iterable, Iterator
from dataclasses import dataclass
from multiprocessing import get_context, parent_process, resource_tracker
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess
from typing import TYPE_CHECKING

import django

if TYPE_CHECKING:  # A new process imports this file before Django is ready for models.
    from parser_service.benchmarking.benchmark_cells import Cell, TrialGroup


@dataclass(slots=True)
class Child:
    """A process that measures ``group``; the first ``answered`` of its trials have their cell or sentence."""

    process: SpawnProcess
    group: TrialGroup
    answered: int = 0


def measure_in_parallel(
    groups: Iterable[TrialGroup], at_once: int
) -> Generator[Cell | str, None, None]:
    """Yield what ``TrialGroup.measure`` yields for all ``groups``, in the order in which it is ready.

    Groups are taken one by one. Where a process ends too early, each of its trials without an answer
    gets a sentence. Closing the generator ends the processes.
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
                assert isinstance(answers, Connection)
                child = running[answers]
                try:
                    answer = answers.recv()
                except (EOFError, OSError):  # OSError where the process ended within a message.
                    del running[answers]
                    child.process.join()
                    yield from _refuse_unanswered(child)
                else:
                    child.answered += 1
                    yield answer
    finally:
        for child in running.values():
            child.process.kill()
            child.process.join()


def _start(group: TrialGroup, running: dict[Connection, Child]) -> None:
    context = get_context("spawn")
    answers, answering = context.Pipe(duplex=False)
    # Pickled here, and unpickled there once Django is ready: its classes import models.
    process = context.Process(target=_measure, args=(pickle.dumps(group), answering))
    resource_tracker.ensure_running()  # Otherwise the first process starts it, and that unblocks.
    # Processes do not hear Ctrl-C: their parent ends them.
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        process.start()
        running[answers] = Child(process, group)
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
    answering.close()  # So that the end of the process is the end of its answers.


def _measure(pickled: bytes, answering: Connection) -> None:
    """Measure a group in a new process. Settings come from the environment, as in the parent."""

    def end_with_parent() -> None:  # without it, nobody reads the cells
        if parent := parent_process():
            parent.join()
            os._exit(1)

    threading.Thread(target=end_with_parent, daemon=True).start()
    django.setup()
    group: TrialGroup = pickle.loads(pickled)
    # Not every parser tests on as many threads as it trains on, and torch takes all cores by default.
    if threads := dict(group.trials[0].configuration).get("threads"):
        os.environ["OMP_NUM_THREADS"] = str(threads)
    for answer in group.measure():
        answering.send(answer)


def _refuse_unanswered(child: Child) -> Iterator[str]:
    code = child.process.exitcode or 0
    how = f"was killed by {signal.Signals(-code).name}" if code < 0 else f"ended with status {code}"
    why = (
        f"the process that measured {child.group} {how}. Measure again what is missing, with a "
        "smaller --jobs where memory ran short."
    )
    for trial in child.group.trials[child.answered :]:
        yield trial.refuse(why)
