"""What a process has counted and shows for a while, where counting it for each page would take long.

It is kept for a time that is long beside that of counting, so that counting takes a small share of a process.
"""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass
from time import monotonic
from typing import Generic, TypeVar

MOST_COUNTED = 10_000  # rows that are counted for each page
# For how many times the seconds of counting something is kept; the second where most of the rows may have changed.
SHARE, SHARE_AFTER_CHANGE = 50, 5
MOST_SECONDS = 600.0

Value = TypeVar("Value")


@dataclass(frozen=True, slots=True)
class Kept(Generic[Value]):
    """A value that took some ``seconds``, counted at that second of ``monotonic``. ``stamp`` is what had last changed
    most of its rows."""

    value: Value
    counted_at: float
    seconds: float
    stamp: Hashable = None

    def is_due(self, stamp: Hashable = None) -> bool:
        """Whether it is to be counted anew."""
        share = SHARE if stamp == self.stamp else SHARE_AFTER_CHANGE
        return self.age >= min(share * self.seconds, MOST_SECONDS)

    @property
    def age(self) -> float:
        """The seconds since it was counted."""
        return monotonic() - self.counted_at
