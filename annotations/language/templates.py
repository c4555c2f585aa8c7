"""Semantic templates ``pattern = form`` (FORMATS §3), read and printed."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from annotations.language.errors import LanguageError, Position, Problem, error, warning
from annotations.language.logic import Application, Form, read_form, to_template
from annotations.language.printing import print_sequence
from annotations.language.symbol_reader import SymbolReader
from annotations.language.symbols import Nonterminal, Sequence, Wildcard
from annotations.language.terms import walk

# What a backslash protects, a brace, an equals sign, or the comment that ends the line.
_MARK = re.compile(r"\\.|[{}=]|#.*")
_EXAMPLE = "a template is pattern = form, as in: fetch the {object} = (bring {object})"


@dataclass(frozen=True, slots=True)
class SemanticTemplate:
    """A partial expansion of a grammar and the form that all its commands share.

    ``form_position`` is where the form begins; positions play no part in equality.
    """

    pattern: Sequence
    form: Form
    pattern_text: str
    form_text: str
    position: Position = field(default_factory=Position, compare=False)
    form_position: Position = field(default_factory=Position, compare=False)

    @property
    def tracked(self) -> frozenset[str]:
        """The nonterminals that the form mentions, as arguments or as predicates."""
        return frozenset(slot.name for slot in self.slots() if isinstance(slot, Nonterminal))

    def slots(self) -> Iterator[Nonterminal | Wildcard]:
        """Every nonterminal and wildcard of the form, in order."""
        for node in walk(self.form):
            if isinstance(node, Application) and isinstance(node.predicate, Nonterminal):
                yield node.predicate
            elif isinstance(node, Nonterminal | Wildcard):
                yield node


def read_templates(
    text: str, source: str = ""
) -> tuple[tuple[SemanticTemplate, ...], tuple[Problem, ...]]:
    """Reads a template file; ``#`` begins a comment. Nothing is raised.

    Returns:
        The templates in order, and what is wrong with the lines that are none.
    """
    templates: list[SemanticTemplate] = []
    problems: list[Problem] = []
    for number, line in enumerate(text.removeprefix("\ufeff").split("\n"), start=1):
        try:
            template = _read_line(line, Position(source, number))
        except LanguageError as trouble:
            problems.append(trouble.problem)
            continue
        if template is not None:
            templates.append(template)
    if not templates:
        problems = [_not_templates(problems, source)]
    return tuple(templates), tuple(problems)


def read_template(line: str, position: Position | None = None) -> SemanticTemplate:
    """Reads one template line.

    Raises:
        LanguageError: no ``=`` or two outside braces, a malformed pattern or form, a variable that
            no λ binds, or nothing but a comment.
    """
    place = position or Position()
    template = _read_line(line, place)
    if template is None:
        raise LanguageError("there is no template here", place, _EXAMPLE)
    return template


def make_template(pattern: str, form: str, position: Position | None = None) -> SemanticTemplate:
    """A template from its two sides, for those who keep them apart.

    Positions of problems in the pattern count from ``position``, those in the form likewise.

    Raises:
        LanguageError: as ``read_template``.
    """
    place = position or Position()
    return _template(pattern, place, form, place)


def print_template(template: SemanticTemplate) -> str:
    """The line that reads back as an equal pattern and form."""
    return f"{print_sequence(template.pattern)} = {to_template(template.form)}"


def _read_line(line: str, place: Position) -> SemanticTemplate | None:
    equals, end = _marks(line)
    if not line[:end].strip():
        return None
    if len(equals) != 1:
        found = f"{len(equals)} equals signs" if equals else "no equals sign"
        column = equals[1] if equals else len(line) - len(line.lstrip())
        raise LanguageError(f"the line has {found} outside braces", place.shifted(column), _EXAMPLE)
    start = equals[0] + 1
    return _template(line[: equals[0]], place, line[start:end], place.shifted(start))


def _marks(line: str) -> tuple[list[int], int]:
    """Where equals signs stand outside braces, and where a comment or the line ends."""
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
    if not pattern.strip():
        raise LanguageError("the template has no pattern", pattern_place, _EXAMPLE)
    pattern_place, form_place = (
        _behind_spaces(pattern, pattern_place),
        _behind_spaces(form, form_place),
    )
    pattern, form = pattern.strip(), form.strip()
    symbols = SymbolReader(pattern, pattern_place).whole_line()
    return SemanticTemplate(
        symbols, read_form(form, form_place), pattern, form, pattern_place, form_place
    )


def _behind_spaces(text: str, place: Position) -> Position:
    return place.shifted(len(text) - len(text.lstrip()))


def _not_templates(problems: list[Problem], source: str) -> Problem:
    """One finding in place of one for every line of a file that is something else."""
    if not problems:
        return warning(Position(source), "the file holds no template", _EXAMPLE)
    if "equals sign" not in problems[0].message:
        return problems[0]
    place = problems[0].position
    return error(place, "the file holds no semantic template", _EXAMPLE)
