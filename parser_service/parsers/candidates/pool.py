"""Candidate forms: which there are, which steps made each, and from what."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

TRAINING = "training"
SURE = 2  # a support that is enough to be answered


@dataclass(frozen=True, slots=True)
class Made:
    """One way to a form.

    ``form`` is canonical corpus text; ``step`` names what made it from the form ``origin`` by
    ``change``; ``commands`` are commands that mean it, if the step makes any. ``weight`` says how
    many kinds of change a step is worth that reaches few forms, and mostly real ones.
    """

    form: str
    step: str
    origin: str = ""
    change: str = ""
    commands: tuple[str, ...] = ()
    weight: int = 1


@dataclass(frozen=True, slots=True)
class Candidate:
    """A form with every way that leads to it."""

    form: str
    ways: tuple[Made, ...]

    @property
    def steps(self) -> tuple[str, ...]:
        """The steps that made it, each once."""
        return tuple(dict.fromkeys(way.step for way in self.ways))

    @property
    def support(self) -> int:
        """How many kinds of step arrive at it.

        Of forms with a support of 1, one in 1,000 is real, that is held out of the published pairs;
        of those with 2 one in 50, with 3 one in 10, with 4 one in 4 (``benchmarks/candidates.py``).
        """
        weights = {way.step: way.weight for way in self.ways}
        for way in self.ways:
            weights[way.step] = max(weights[way.step], way.weight)
        return sum(weights.values())

    @property
    def commands(self) -> tuple[str, ...]:
        """What the steps say for it."""
        return tuple(dict.fromkeys(said for way in self.ways for said in way.commands))


@dataclass
class Pool:
    """The ways that all steps found, by form, in the order in which they were found."""

    ways: dict[str, list[Made]] = field(default_factory=dict)

    def add(self, made: Iterable[Made]) -> None:
        for each in made:
            self.ways.setdefault(each.form, []).append(each)

    def candidates(self) -> Iterator[Candidate]:
        """All forms, the best supported first, then in the order in which they were found."""
        found = [Candidate(form, tuple(ways)) for form, ways in self.ways.items()]
        yield from sorted(found, key=lambda each: -each.support)

    def counts(self) -> dict[str, int]:
        """How many forms each step made."""
        return dict(Counter(step for each in self.candidates() for step in each.steps))
