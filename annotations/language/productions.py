"""Productions of a GPSRCmdGen grammar file, read and printed (FORMATS §1)."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field

from annotations.language.comments import Import, find_heading, find_imports, split_comments
from annotations.language.errors import LanguageError, Position, Problem, error
from annotations.language.printing import print_sequence
from annotations.language.symbol_reader import SymbolReader
from annotations.language.symbols import Sequence

_PRODUCTION = re.compile(r"\s*\$(?P<head>[^\W\d]\w*)\s*=(?P<expansion>.*)")
TIERS = ("Easy", "Moderate", "High")


@dataclass(frozen=True, slots=True)
class Production:
    """One line ``$nonterminal = expansion``; several for one nonterminal are alternatives.

    ``references`` says where the nonterminals of the expansion stand, notes for the referee included.
    """

    nonterminal: str
    expansion: Sequence
    position: Position = field(default_factory=Position, compare=False)
    references: tuple[tuple[str, Position], ...] = field(default=(), compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class GrammarFile:
    """What one file holds. ``imports`` are not followed; ``problems`` are those of this file alone."""

    source: str
    name: str
    tier: str
    imports: tuple[Import, ...]
    productions: tuple[Production, ...]
    problems: tuple[Problem, ...]

    def defines(self, nonterminal: str) -> bool:
        return any(production.nonterminal == nonterminal for production in self.productions)


def read_productions(text: str, source: str = "") -> GrammarFile:
    """Reads a grammar file. Nothing is raised: every fault is among the problems.

    Args:
        text: the file's text (``decoding.decode`` takes care of its encoding).
        source: the file's name, for positions.
    """
    try:
        body, comments = split_comments(text.removeprefix("\ufeff"), source)
    except LanguageError as trouble:
        return GrammarFile(source, "", "", (), (), (trouble.problem,))
    productions: list[Production] = []
    problems: list[Problem] = []
    for number, line in enumerate(body.split("\n"), start=1):
        if not line.strip():
            continue
        try:
            productions.append(read_production(line, Position(source, number)))
        except LanguageError as trouble:
            problems.append(trouble.problem)
    imports = find_imports(comments)
    if not productions and not imports:
        problems = [_not_a_grammar(problems, source)]
    name, tier = find_heading(comments, "name"), find_heading(comments, "tier")
    return GrammarFile(source, name, tier, imports, tuple(productions), tuple(problems))


def read_production(line: str, position: Position | None = None) -> Production:
    """Reads one line ``$name = expansion`` without comments.

    Raises:
        LanguageError: the line is no production, or its expansion is malformed.
    """
    place = position or Position()
    found = _PRODUCTION.fullmatch(line)
    if found is None:
        raise LanguageError(
            "this line is neither a production nor a comment",
            place.shifted(len(line) - len(line.lstrip())),
            "a production is $name = expansion; a comment begins with #, ;, % or //",
        )
    start = found.start("expansion")
    if not found["expansion"].strip():
        raise LanguageError(
            f"${found['head']} has no expansion", place.shifted(start), "write {void} for no words"
        )
    reader = SymbolReader(found["expansion"], place.shifted(start))
    expansion = reader.whole_line()
    head = place.shifted(found.start("head") - 1)
    return Production(found["head"], expansion, head, tuple(reader.references))


def print_production(production: Production) -> str:
    """The line that reads back as an equal production."""
    return f"${production.nonterminal} = {print_sequence(production.expansion)}"


def print_productions(productions: Iterable[Production]) -> str:
    """A grammar file of nothing but these productions, one a line."""
    return "".join(f"{print_production(production)}\n" for production in productions)


def _not_a_grammar(problems: list[Problem], source: str) -> Problem:
    """One finding in place of one for every line of a file that is something else."""
    if problems and "neither a production" not in problems[0].message:
        return problems[0]
    place = problems[0].position if problems else Position(source)
    return error(
        place,
        "the file is no grammar: it holds neither a production nor an import",
        "a production is a line $Name = expansion",
    )
