"""How much work an expansion may do; discarded results count as much as those that are kept."""

from __future__ import annotations

from math import inf

from annotations.language.texts import LanguageError, Position

# For an answer that somebody waits for: a fraction of a second.
CHECK_STEPS = 2_000_000


class TooManyCombinations(LanguageError):
    """A pattern or a grammar has more combinations than its budget allows."""


class Budget:
    """A number of steps shared by everything that one answer needs.

    One step is about the work of adding one symbol to a result: 0.1 to 0.5 µs. Without ``steps``
    there is no limit.
    """

    def __init__(self, steps: int | None = None) -> None:
        self.steps = steps
        self.spent = 0
        self._limit = inf if steps is None else steps

    def spend(self, steps: int = 1) -> None:
        """Spend steps. Raise TooManyCombinations once more steps are spent than the budget has."""
        self.spent += steps
        if self.spent > self._limit:
            raise TooManyCombinations(
                f"too many combinations to look through (more than {self.steps:,} steps)",
                Position(),
                "narrow the pattern: fewer choices, or fewer nonterminals next to each other",
            )
