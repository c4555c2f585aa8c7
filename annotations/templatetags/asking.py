"""Template tags: what people are asked about an example of a split, and how long a text they may send."""

from __future__ import annotations

from dataclasses import dataclass

from django import template

from annotations.labelling.enqueuing import ItemSubject, field_of
from annotations.labelling.sent_examples import subject_of_example
from annotations.models import Example, SemanticTemplate
from annotations.models.corpus import MOST_CHARACTERS
from annotations.rows.occurrences import command_of_example
from annotations.web.labelling.work_item_forms import LONGEST_QUESTION

register = template.Library()

LIMITS = {"question": LONGEST_QUESTION, "reason": MOST_CHARACTERS, "utterance": MOST_CHARACTERS}


@register.simple_tag
def longest(text: str) -> int:
    """Return how many characters a question about a row, a reason or an utterance may have."""
    return LIMITS[text]


@dataclass(frozen=True, slots=True)
class Behind:
    """The row that people would be asked about: ``kind`` is the name of its page. ``template`` is that of
    the command that the example is, or rewrites; each is None where it is not known."""

    kind: str
    row: ItemSubject | None
    template: SemanticTemplate | None


@register.simple_tag
def behind_example(example: Example) -> Behind:
    """Return what ``example`` was copied from. A few queries."""
    row = subject_of_example(example)
    command = command_of_example(example)
    return Behind(field_of(row) if row else "", row, command.template if command else None)
