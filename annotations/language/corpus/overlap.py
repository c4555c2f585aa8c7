"""How much of what one part of a split asks for, another part has."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True, order=True)
class FormOverlap:
    """A form that ``asked`` pairs of a part have, and ``taught`` pairs of the training part."""

    asked: int
    taught: int


@dataclass(frozen=True, slots=True)
class Overlap:
    """The forms that a part asks for, and what the training part has of them.

    ``new_commands`` counts the pairs that rewrite a command which no training pair has or rewrites.
    """

    forms: tuple[FormOverlap, ...] = ()
    new_commands: int = 0

    @property
    def examples(self) -> int:
        return sum(form.asked for form in self.forms)

    @property
    def new_forms(self) -> int:
        """How many forms no training pair has."""
        return sum(not form.taught for form in self.forms)

    @property
    def examples_of_new_forms(self) -> int:
        return sum(form.asked for form in self.forms if not form.taught)

    @property
    def new_form_share(self) -> float:
        """The share of forms, or of pairs where that is larger, that training does not have; a fraction of 1."""
        if not self.forms:
            return 0.0
        return max(self.new_forms / len(self.forms), self.examples_of_new_forms / self.examples)

    @property
    def new_command_share(self) -> float:
        return self.new_commands / self.examples if self.forms else 0.0


def overlap_of(
    asked: Mapping[str, int], taught: Mapping[str, int], new_commands: int = 0
) -> Overlap:
    """Return the overlap of forms that ``asked`` and ``taught`` count pairs of, those of fewest pairs first."""
    forms = (FormOverlap(count, taught.get(form, 0)) for form, count in asked.items())
    return Overlap(tuple(sorted(forms)), new_commands)


def together(overlaps: Iterable[Overlap]) -> Overlap:
    """Return several overlaps as one. A form that two of them have counts twice."""
    several = list(overlaps)
    forms = tuple(form for overlap in several for form in overlap.forms)
    return Overlap(forms, sum(overlap.new_commands for overlap in several))
