"""Read and print the productions of a GPSRCmdGen grammar file (FORMATS §1)."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from annotations.language.errors import LanguageError, Position, Problem, error_at
from annotations.language.grammar.comments import Import, find_heading, find_imports, split_comments
from annotations.language.limits import MAX_NONTERMINAL, require_name
from annotations.language.symbols import SymbolReader, Symbols, print_sequence

_PRODUCTION = re.compile(r"\s*\$(?P<head>[^\W\d]\w*)\s*=(?P<expansion>.*)")


@dataclass(frozen=True, slots=True)
class Production:
    """One line ``$nonterminal = expansion``; several lines for one nonterminal are alternatives.

    ``references`` lists the nonterminals of the expansion with their positions, including those in
    notes for the referee.
    """

    nonterminal: str
    expansion: Symbols
    position: Position = field(default_factory=Position, compare=False)
    references: tuple[tuple[str, Position], ...] = field(default=(), compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class GrammarFile:
    """The content of one file. ``imports`` are not followed; ``problems`` are those of this file alone."""

    source: str
    name: str
    tier: str
    imports: tuple[Import, ...]
    productions: tuple[Production, ...]
    problems: tuple[Problem, ...]

    def defines(self, nonterminal: str) -> bool:
        return any(production.nonterminal == nonterminal for production in self.productions)


def read_productions(text: str, source: str = "") -> GrammarFile:
    """Read a grammar file. Errors are not raised but listed in ``problems``.

    Args:
        text: the file's text (``decoding.decode`` takes care of its encoding).
        source: the file's name, for positions.
    """
    try:
        body, comments = split_comments(text.removeprefix("\ufeff"), source)
    except LanguageError as error:
        return GrammarFile(source, "", "", (), (), (error.problem,))
    productions: list[Production] = []
    problems: list[Problem] = []
    for number, line in enumerate(body.split("\n"), start=1):
        if not line.strip():
            continue
        try:
            productions.append(read_production(line, Position(source, number)))
        except LanguageError as error:
            problems.append(error.problem)
    imports = find_imports(comments)
    if not productions and not imports:
        problems = [_not_a_grammar(problems, source)]
    name, tier = find_heading(comments, "name"), find_heading(comments, "tier")
    return GrammarFile(source, name, tier, imports, tuple(productions), tuple(problems))


def read_production(line: str, position: Position | None = None) -> Production:
    """Read one line ``$name = expansion`` without comments.

    Raises:
        LanguageError: the line is not a production, or its expansion is malformed.
    """
    place = position or Position()
    match = _PRODUCTION.fullmatch(line)
    if match is None:
        raise LanguageError(
            "this line is neither a production nor a comment",
            place.shifted(len(line) - len(line.lstrip())),
            "a production is $name = expansion; a comment begins with #, ;, % or //",
        )
    start = match.start("expansion")
    if not match["expansion"].strip():
        raise LanguageError(
            f"${match['head']} has no expansion", place.shifted(start), "write {void} for no words"
        )
    reader = SymbolReader(match["expansion"], place.shifted(start))
    expansion = reader.whole_line()
    head = place.shifted(match.start("head") - 1)
    require_name(match["head"], "nonterminal", MAX_NONTERMINAL, head)
    return Production(match["head"], expansion, head, tuple(reader.references))


def print_production(production: Production) -> str:
    """Return the line that reads back as an equal production."""
    return f"${production.nonterminal} = {print_sequence(production.expansion)}"


def _not_a_grammar(problems: list[Problem], source: str) -> Problem:
    """Return one problem for a file that is not a grammar, instead of one for each line."""
    if problems and "neither a production" not in problems[0].message:
        return problems[0]
    place = problems[0].position if problems else Position(source)
    return error_at(
        place,
        "this is not a grammar file: it has neither a production nor an import",
        "a production is a line $Name = expansion",
    )
