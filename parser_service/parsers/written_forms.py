"""Forms in the texts that parsers write."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from annotations.language.forms import (
    SEQUENCE,
    Application,
    Form,
    actions_of,
    canonical_text,
    read_or_none,
)


@lru_cache(maxsize=10_000)
def canonical(text: str) -> str | None:
    """Return the canonical text of a written form; None where it is not a form."""
    form = read_or_none(text)
    return None if form is None else canonical_text(form)


def canonical_or_same(text: str) -> str:
    """Return the canonical text of a written form, or the text itself where it is not a form."""
    canonical_form = canonical(text)
    return text if canonical_form is None else canonical_form


def in_order(actions: Sequence[Form]) -> Form:
    """Return the form that has ``actions``, one or more, in order."""
    return actions[0] if len(actions) == 1 else Application(SEQUENCE, tuple(actions))


@lru_cache(maxsize=10_000)
def written_actions(form: str) -> tuple[str, ...]:
    """Return the canonical texts of the actions of a written form; the text itself where it is not a form."""
    read = read_or_none(form)
    return (form,) if read is None else tuple(map(canonical_text, actions_of(read)))
