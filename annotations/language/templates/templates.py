"""Read and print semantic templates (docs/reference/formats.md, Templates).

``pattern = form`` annotates commands; ``$name -> pattern = form`` annotates what ``$name`` may become.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import lru_cache
from typing import NamedTuple

from annotations.language.forms import (
    DEFAULT_CLASSES,
    UNKNOWN,
    Application,
    EntityClasses,
    Form,
    Nonterminal,
    SymbolReader,
    Symbols,
    Wildcard,
    kinds_in_form,
    kinds_in_pattern,
    plain_marks,
    print_sequence,
    read_template_form,
    split_head,
    to_template,
    walk,
)
from annotations.language.texts import (
    MAX_NONTERMINAL,
    MAX_PATTERN,
    LanguageError,
    Position,
    Problem,
    error_at,
    require_length,
    require_name,
    warning_at,
)

# An escaped character, a brace, an equals sign, or the comment that ends the line.
_MARK = re.compile(r"\\.|[{}=]|#.*")
_EXAMPLE = "a template is pattern = form, as in: fetch the {object} = (bring {object})"
_LINE_EXAMPLE = "a line for a nonterminal is $name -> pattern = form"


@dataclass(frozen=True, slots=True)
class SemanticTemplate:
    """A partial expansion of a grammar and the form that all its commands share.

    ``nonterminal`` is what a line ``$name -> pattern = form`` is for, empty for a template of commands.
    ``pattern_text`` is the whole left side, with the nonterminal before the arrow. ``form_position`` is where
    the form begins; positions play no part in equality.
    """

    pattern: Symbols
    form: Form
    pattern_text: str
    form_text: str
    position: Position = field(default_factory=Position, compare=False)
    form_position: Position = field(default_factory=Position, compare=False)
    nonterminal: str = ""

    @property
    def texts(self) -> tuple[str, str]:
        return self.pattern_text, self.form_text

    @property
    def tracked(self) -> frozenset[str]:
        """The nonterminals that the form mentions, as arguments or as predicates."""
        return frozenset(slot.name for slot in self.slots() if isinstance(slot, Nonterminal))

    def slots(self) -> Iterator[Nonterminal | Wildcard]:
        """Yield every nonterminal and wildcard of the form, in order."""
        for node in walk(self.form):
            if isinstance(node, Application) and isinstance(node.predicate, Nonterminal):
                yield node.predicate
            elif isinstance(node, Nonterminal | Wildcard):
                yield node


def read_templates(
    text: str, source: str = "", classes: EntityClasses = DEFAULT_CLASSES
) -> tuple[tuple[SemanticTemplate, ...], tuple[Problem, ...]]:
    """Read a template file; ``#`` begins a comment. Errors are returned, not raised.

    Args:
        text: the file's text.
        source: the file's name, for positions.
        classes: those that wildcards may be of.

    Returns:
        The templates in order, and the problems of the lines that are not templates.
    """
    templates: list[SemanticTemplate] = []
    problems: list[Problem] = []
    for number, line in enumerate(text.removeprefix("\ufeff").split("\n"), start=1):
        try:
            template = _read_line(line, Position(source, number))
        except LanguageError as error:
            problems.append(error.problem)
            continue
        if template is None:
            continue
        unknown = (
            *kinds_in_pattern(template.pattern_text, classes, template.position),
            *kinds_in_form(template.form_text, classes, template.form_position),
        )
        problems.extend(unknown)
        templates += () if unknown else (template,)
    if not templates and not any(_marks(line)[0] for line in text.split("\n")):
        # One problem for a file without templates, instead of one for each line.
        if problems:
            place = problems[0].position
            problems = [error_at(place, "the file holds no semantic template", _EXAMPLE)]
        else:
            problems = [warning_at(Position(source), "the file holds no template", _EXAMPLE)]
    return tuple(templates), tuple(problems)


def read_template(line: str, position: Position | None = None) -> SemanticTemplate:
    """Read one template line.

    Raises:
        LanguageError: no ``=`` outside braces, or more than one, a malformed pattern or form, a variable that
            no λ binds, or nothing but a comment.
    """
    place = position or Position()
    template = _read_line(line, place)
    if template is None:
        raise LanguageError("there is no template here", place, _EXAMPLE)
    return template


def make_template(pattern: str, form: str, position: Position | None = None) -> SemanticTemplate:
    """Make a template from its two sides.

    Positions in the pattern and in the form both count from ``position``.

    Raises:
        LanguageError: as ``read_template``.
    """
    place = position or Position()
    return _template(pattern, place, form, place)


def read_sides(pattern: str, form: str) -> tuple[SemanticTemplate | None, tuple[Problem, ...]]:
    """Make a template as somebody types it; positions count in the texts ``pattern`` and ``form``.

    Returns:
        The template, or None and what keeps each of its sides from being read.
    """
    problems: list[Problem] = []
    left, right = _Left("", (), "", Position()), _Right(UNKNOWN, "", Position())
    try:
        left = _read_left(pattern, Position("pattern"))
    except LanguageError as error:
        problems.append(error.problem)
    try:
        right = _read_right(form, Position("form"))
    except LanguageError as error:
        problems.append(error.problem)
    return (None, tuple(problems)) if problems else (_join(left, right), ())


def print_template(template: SemanticTemplate) -> str:
    """Return the line that reads back as an equal pattern and form."""
    head = f"${template.nonterminal} -> " if template.nonterminal else ""
    return f"{head}{print_sequence(template.pattern)} = {to_template(template.form)}"


def _read_line(line: str, place: Position) -> SemanticTemplate | None:
    equals, end = _marks(line)
    if not line[:end].strip():
        return None
    if len(equals) != 1:
        count = f"{len(equals)} equals signs" if equals else "no equals sign"
        column = equals[1] if equals else len(line) - len(line.lstrip())
        raise LanguageError(f"the line has {count} outside braces", place.shifted(column), _EXAMPLE)
    start = equals[0] + 1
    return _template(line[: equals[0]], place, line[start:end], place.shifted(start))


def _marks(line: str) -> tuple[list[int], int]:
    """Return where equals signs are outside braces, and where a comment begins or the line ends."""
    depth = 0
    equals: list[int] = []
    for mark in _MARK.finditer(line):
        if mark.group().startswith("#"):
            return equals, mark.start()
        depth += {"{": 1, "}": -1}.get(mark.group(), 0)
        if mark.group() == "=" and depth <= 0:
            equals.append(mark.start())
    return equals, len(line)


def _template(
    pattern: str, pattern_place: Position, form: str, form_place: Position
) -> SemanticTemplate:
    return _join(_read_left(pattern, pattern_place), _read_right(form, form_place))


class _Left(NamedTuple):
    """What stands before the equals sign, its text without the spaces around it, and where that begins."""

    nonterminal: str
    pattern: Symbols
    text: str
    position: Position


class _Right(NamedTuple):
    form: Form
    text: str
    position: Position


def _join(left: _Left, right: _Right) -> SemanticTemplate:
    return SemanticTemplate(
        *(left.pattern, right.form, left.text, right.text, left.position, right.position),
        nonterminal=left.nonterminal,
    )


def _read_left(text: str, place: Position) -> _Left:
    if not text.strip():
        raise LanguageError("the template has no pattern", place, _EXAMPLE)
    place, text = _behind_spaces(text, place), text.strip()
    require_length(text, "pattern", MAX_PATTERN, place)
    name, start = split_head(text)
    if name:
        require_name(name, "nonterminal", MAX_NONTERMINAL, place)
        if not text[start:].strip():
            raise LanguageError("nothing follows the arrow", place.shifted(start), _LINE_EXAMPLE)
    try:
        return _Left(name, _symbols(text[start:]), text, place)
    except LanguageError as error:
        inside = error.position.inside(place.shifted(start))
        raise LanguageError(error.message, inside, error.hint) from None


@lru_cache(maxsize=1 << 12)
def _symbols(text: str) -> Symbols:
    return SymbolReader(text, Position()).whole_line()


def _read_right(text: str, place: Position) -> _Right:
    place, text = _behind_spaces(text, place), plain_marks(text.strip())
    return _Right(read_template_form(text, place), text, place)


def _behind_spaces(text: str, place: Position) -> Position:
    return place.shifted(len(text) - len(text.lstrip()))
