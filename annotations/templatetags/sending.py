"""Template tags: what stands behind an example of a split."""

from __future__ import annotations

from dataclasses import dataclass

from django import template

from annotations.models import Example, SemanticTemplate
from annotations.queueing.enqueuing import Subject, field_of
from annotations.queueing.sending import subject_of_example
from annotations.rows.occurrences import command_of_example

register = template.Library()


@dataclass(frozen=True, slots=True)
class Behind:
    """The row that people would be asked about: ``kind`` is the name of its page. ``template`` is that of
    the command that the example is, or rewrites; each is None where it is not known."""

    kind: str
    row: Subject | None
    template: SemanticTemplate | None


@register.simple_tag
def behind_example(example: Example) -> Behind:
    """Return what ``example`` was copied from. A few queries."""
    row = subject_of_example(example)
    command = command_of_example(example)
    return Behind(field_of(row) if row else "", row, command.template if command else None)
