"""Templates as examples to learn from: the units of the pattern beside the form."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from annotations.language.forms import Form, canonical_text, canonicalize
from annotations.language.suggesting.slots import labels_of, with_classes
from annotations.language.suggesting.units import Unit, UnitReader
from annotations.language.templates import SemanticTemplate, TaskCategory

# More templates than this are not looked at; the first are.
MOST_EXAMPLES = 2_000


@dataclass(frozen=True)
class Example:
    """A template with the units of its pattern; ``form`` is canonical."""

    units: tuple[Unit, ...]
    form: Form
    template: SemanticTemplate

    @cached_property
    def bag(self) -> Counter[str]:
        """How often each label occurs in the pattern."""
        return Counter(unit.label for unit in self.units)

    @cached_property
    def typed_form(self) -> Form:
        """The form with class tokens for its slots."""
        return with_classes(self.form, labels_of(self.units))


def examples_of(categories: Sequence[TaskCategory]) -> tuple[Example, ...]:
    """Return the distinct templates of task categories, at most ``MOST_EXAMPLES``, in order."""
    examples: dict[tuple[object, str], Example] = {}
    for category in categories:
        reader = UnitReader(category.grammar)
        for template in category.templates:
            key = (template.pattern, canonical_text(template.form))
            if key not in examples and len(examples) < MOST_EXAMPLES:
                units = reader.units(template.pattern)
                examples[key] = Example(units, canonicalize(template.form), template)
    return tuple(examples.values())
