"""Wildcards of kinds that a world does not have, in texts that can be read."""

from __future__ import annotations

import re
from collections.abc import Iterator

from annotations.language.forms.entity_classes import EntityClasses, wildcard_names
from annotations.language.forms.reader import no_such_kind
from annotations.language.texts import Offsets, Position, Problem, error_at

# The first word in the braces of a wildcard, which may end in its number.
_KIND = r"\{\s*+(?P<kind>[^\W\d]\w*+)"
_IN_PATTERN = re.compile(rf"\\.|{_KIND}", re.DOTALL)
_IN_FORM = re.compile(rf'"[^"]*"|{_KIND}')


def kinds_in_pattern(text: str, classes: EntityClasses, place: Position) -> Iterator[Problem]:
    """Yield an error for each wildcard of a pattern or an expansion, also in notes, that is of no class.

    Args:
        place: where the text begins.
    """
    return _unknown(_IN_PATTERN, text, classes, place)


def kinds_in_form(text: str, classes: EntityClasses, place: Position) -> Iterator[Problem]:
    """Yield an error for each wildcard of a form that is of no class; ``place`` is where the text begins."""
    return _unknown(_IN_FORM, text, classes, place)


def _unknown(
    pattern: re.Pattern[str], text: str, classes: EntityClasses, place: Position
) -> Iterator[Problem]:
    names = wildcard_names(classes)
    for match in pattern.finditer(text):
        kind = (match["kind"] or "").rstrip("0123456789")
        if kind and kind.lower() not in names:
            at = Offsets(text).position(match.start("kind")).inside(place)
            yield error_at(at, *no_such_kind(kind, classes))
