"""Candidate forms, with the steps that made each and what they made it from."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

SURE = 2  # the support that a form needs to become a candidate


@dataclass(frozen=True, slots=True)
class WayToForm:
    """One way to a form.

    ``form`` is canonical corpus text; ``step`` names what made it from the form ``origin`` by
    ``change``; ``commands`` are commands that mean it, if the step makes any. ``weight`` is the number
    of kinds of change that the step counts for: more than one where it makes few forms, mostly real.
    """

    form: str
    step: str
    origin: str = ""
    change: str = ""
    commands: tuple[str, ...] = ()
    weight: int = 1


@dataclass(frozen=True, slots=True)
class CandidateForm:
    """A form with every way to it."""

    form: str
    ways: tuple[WayToForm, ...]

    @property
    def steps(self) -> tuple[str, ...]:
        """Return the steps that made it, each once."""
        return tuple(dict.fromkeys(way.step for way in self.ways))

    @property
    def main_step(self) -> str:
        """Return the step that counts most, the first of several."""
        return max(self.ways, key=lambda way: way.weight).step

    @property
    def support(self) -> int:
        """Count the kinds of step that arrive at it, by their weights.

        Of forms with a support of 1, one in 1,000 is real, that is held out of the published pairs;
        of those with 2 one in 50, with 3 one in 10, with 4 one in 4 (``benchmarks/parsing/candidates.py``).
        """
        weights = {way.step: way.weight for way in self.ways}
        for way in self.ways:
            weights[way.step] = max(weights[way.step], way.weight)
        return sum(weights.values())

    @property
    def commands(self) -> tuple[str, ...]:
        """Return the commands that the steps made for it."""
        return tuple(dict.fromkeys(said for way in self.ways for said in way.commands))


@dataclass
class Pool:
    """The ways of all steps, by form, in the order in which they were added."""

    ways: dict[str, list[WayToForm]] = field(default_factory=dict)

    def add(self, made: Iterable[WayToForm]) -> None:
        for each in made:
            self.ways.setdefault(each.form, []).append(each)

    def candidates(self) -> Iterator[CandidateForm]:
        """Yield all forms, the best supported first, then in the order in which they were added."""
        candidates = [CandidateForm(form, tuple(ways)) for form, ways in self.ways.items()]
        yield from sorted(candidates, key=lambda each: -each.support)

    def counts(self) -> dict[str, int]:
        """Count the forms that each step made."""
        return dict(Counter(step for each in self.candidates() for step in each.steps))
