"""Measures how long code of ours keeps others from writing: SQLite lets one transaction write at a time."""

from __future__ import annotations

import gc
import sys
import time
from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from threading import get_ident
from traceback import walk_stack
from types import FrameType
from unittest.mock import patch

from django.db.transaction import Atomic, get_connection

from tests.timing import idle_seconds

ROOT = Path(__file__).resolve().parent.parent
OURS = tuple(str(ROOT / name) for name in ("annotations", "parser_service", "gpsr_site"))
OURS_AND_TESTS = (*OURS, str(ROOT / "tests"))

# Seconds of processor time, as on an idle core. Waiting for other processes does not count, nor does
# collecting garbage: the heap of a whole test run takes long, and any statement can be the one to start it.
LONGEST_IN_JOBS = 0.2
LONGEST = 1.0  # in requests and commands

# What may take longer, since a part of it alone would be wrong. All of it is computed before, and written
# with few statements.
WHOLE = {
    "annotations/generation/generating.py:_generate_once": "commands and forms change together",
    "annotations/exchange/generator_import.py:_compare_and_store": "a grammar and its templates are imported whole",
    "annotations/exchange/pair_import.py:_store": "splits and the paraphrases in them are imported whole",
    "annotations/generation/freezing.py:freeze_split": "a split is there whole, and never changes",
    "annotations/generation/renewing.py:freeze_anew": "a split is there whole, and never changes",
}


@dataclass(frozen=True, slots=True)
class Lasted:
    """A transaction: the function of ours that opened it, its seconds of processor time, and whether a
    job did."""

    place: str
    seconds: float
    is_in_job: bool

    @property
    def is_too_long(self) -> bool:
        longest = LONGEST_IN_JOBS if self.is_in_job else LONGEST
        return self.seconds > longest and self.place not in WHOLE


@contextmanager
def measured_transactions(longer_than: float = LONGEST_IN_JOBS) -> Iterator[list[Lasted]]:
    """Yield a list that gets each transaction of ours that takes longer, savepoints left out."""
    lasted: list[Lasted] = []
    begun: dict[int, list[tuple[Atomic, float]]] = defaultdict(list)  # by thread
    collecting: dict[int, float] = defaultdict(float)  # by thread
    enter, leave = Atomic.__enter__, Atomic.__exit__

    def count_collecting(phase: str, _: object) -> None:
        collecting[get_ident()] += time.thread_time() * (1 if phase == "stop" else -1)

    def own_time() -> float:
        return time.thread_time() - collecting[get_ident()]

    def begin(atomic: Atomic) -> None:
        around = get_connection(atomic.using).atomic_blocks
        is_outermost = all(block._from_testcase for block in around)
        enter(atomic)
        if is_outermost and not atomic._from_testcase:
            begun[get_ident()].append((atomic, own_time()))

    def end(atomic: Atomic, *raised: object) -> None:
        leave(atomic, *raised)
        mine = begun[get_ident()]
        if mine and mine[-1][0] is atomic:
            seconds = own_time() - mine.pop()[1]
            if seconds > longer_than:
                lasted.extend(_describe(sys._getframe(1), idle_seconds(seconds)))

    gc.callbacks.append(count_collecting)
    try:
        with patch.multiple(Atomic, __enter__=begin, __exit__=end):
            yield lasted
    finally:
        gc.callbacks.remove(count_collecting)


def _describe(frame: FrameType, seconds: float) -> Iterator[Lasted]:
    """Yield the transaction that ``frame`` holds, unless a test opened it."""
    paths = [(each.f_code.co_filename, each.f_code.co_name) for each, _ in walk_stack(frame)]
    first = next(
        (each for each in paths if each[0].startswith(OURS_AND_TESTS) and not _only_opens(each[0])),
        None,
    )
    if first and first[0].startswith(OURS):
        is_in_job = any(path.endswith("background/carrying_out.py") for path, _ in paths)
        yield Lasted(f"{Path(first[0]).relative_to(ROOT)}:{first[1]}", seconds, is_in_job)


def _only_opens(path: str) -> bool:
    """Return whether a module opens the transactions of others."""
    return path.endswith(("background/fencing.py", "background/outages.py", "jobs/watching.py"))
