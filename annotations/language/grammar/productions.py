"""Read and print the productions of a GPSRCmdGen grammar file (docs/reference/formats.md, Grammars)."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from annotations.language.forms import (
    DEFAULT_CLASSES,
    EntityClasses,
    SymbolReader,
    Symbols,
    lone_closing_parentheses,
    print_sequence,
)
from annotations.language.texts import (
    MAX_NONTERMINAL,
    LanguageError,
    Offsets,
    Position,
    Problem,
    error_at,
    require_name,
    warning_at,
)

# In this order: an escaped character, a block, an unclosed block, a comment to the end of the line.
_COMMENT = re.compile(
    r"\\.|(?P<block>/\*.*?\*/)|(?P<open>/\*.*)|(?P<line>(?:[#;%]|//)[^\n]*)", re.DOTALL
)
_LINE_SIGN = re.compile(r"[#;%]|//")
_PATH = r"""(?:"(?P<double>[^"]+)"|'(?P<single>[^']+)'|(?P<bare>\S+))"""
_IMPORT = re.compile(rf"(?:import|load)\s+{_PATH}(?:\s+as\s+\$(?P<alias>\w+))?\s*", re.IGNORECASE)
_HEADING = re.compile(r"grammar\s+(?P<key>name|tier)\s++(?P<value>\S.*)", re.IGNORECASE)
_PRODUCTION = re.compile(r"\s*\$(?P<head>[^\W\d]\w*)\s*=(?P<expansion>.*)")


@dataclass(frozen=True, slots=True)
class GrammarComment:
    """The text of one comment, without its sign."""

    text: str
    position: Position


@dataclass(frozen=True, slots=True)
class Import:
    """``; import path`` or ``; import path as $alias``."""

    path: str
    alias: str
    position: Position


def split_comments(
    text: str, source: str, problems: list[Problem]
) -> tuple[str, tuple[GrammarComment, ...]]:
    """Take the comments out of a grammar file. A ``/*`` that is never closed is added to ``problems``.

    Returns:
        The text with spaces where comments stood, so that lines and columns keep their numbers,
        and the comments in order.
    """
    comments: list[GrammarComment] = []
    offsets = Offsets(text, source)

    def blank(match: re.Match[str]) -> str:
        if match["block"] is None and match["open"] is None and match["line"] is None:
            return match.group()
        place = offsets.position(match.start())
        if match["open"]:
            sentence = "the comment opened here is never closed"
            problems.append(error_at(place, sentence, "close it with */"))
        else:
            words = match["block"][2:-2] if match["block"] else _LINE_SIGN.sub("", match["line"], 1)
            comments.append(GrammarComment(words.strip(), place))
        return re.sub(r"[^\n]", " ", match.group())

    return _COMMENT.sub(blank, text), tuple(comments)


def find_imports(comments: tuple[GrammarComment, ...]) -> tuple[Import, ...]:
    """Return the import and load directives among the comments, in order."""
    matches = ((comment, _IMPORT.fullmatch(comment.text)) for comment in comments)
    return tuple(
        Import(
            match["double"] or match["single"] or match["bare"],
            match["alias"] or "",
            comment.position,
        )
        for comment, match in matches
        if match is not None
    )


def find_heading(comments: tuple[GrammarComment, ...], key: str) -> str:
    """Return the last value of ``grammar name …`` or ``grammar tier …``, or an empty string."""
    value = ""
    for comment in comments:
        match = _HEADING.fullmatch(comment.text)
        if match is not None and match["key"].lower() == key:
            value = match["value"]
    return value


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
    """The content of one file. ``imports`` are not followed; ``problems`` are those of this file alone.

    A file ``is_prose`` if no line is or looks like a production, and it imports nothing. ``heads`` are the
    nonterminals of the lines that are or look like productions, if most lines do.
    """

    source: str
    name: str
    tier: str
    imports: tuple[Import, ...]
    productions: tuple[Production, ...]
    problems: tuple[Problem, ...]
    is_prose: bool = False
    heads: frozenset[str] = frozenset()

    def defines(self, nonterminal: str) -> bool:
        return any(production.nonterminal == nonterminal for production in self.productions)

    def means(self, nonterminal: str) -> bool:
        """Whether the file defines the nonterminal, or would if its lines had no faults."""
        return self.defines(nonterminal) or nonterminal in self.heads


def read_productions(
    text: str, source: str = "", classes: EntityClasses = DEFAULT_CLASSES
) -> GrammarFile:
    """Read a grammar file. Errors are not raised but listed in ``problems``, each at its place.

    What GPSRCmdGen accepts silently is accepted with a warning: a production without an expansion is left
    out, and so is a closing parenthesis at the end of a production that nothing opens.

    Args:
        text: the file's text (``decoding.decode`` takes care of its encoding).
        source: the file's name, for positions.
        classes: those that wildcards may be of.
    """
    problems: list[Problem] = []
    body, comments = split_comments(text.removeprefix("\ufeff"), source, problems)
    productions: list[Production] = []
    places = [
        (line, Position(source, number))
        for number, line in enumerate(body.split("\n"), start=1)
        if line.strip()
    ]
    imports = find_imports(comments)
    if not imports and not any(_PRODUCTION.match(line) for line, _ in places):
        start = places[0][1] if places else Position(source)
        warning = warning_at(
            start,
            "this is not a grammar file: it has neither a production nor an import",
            "a production is a line $Name = expansion",
        )
        return GrammarFile(source, "", "", (), (), (warning,), is_prose=True)
    for line, place in places:
        try:
            if (production := _read_line(line, place, problems, classes)) is not None:
                productions.append(production)
        except LanguageError as error:
            problems.append(error.problem)
    name, tier = find_heading(comments, "name"), find_heading(comments, "tier")
    heads = [match["head"] for line, _ in places if (match := _PRODUCTION.match(line))]
    return GrammarFile(
        *(source, name, tier, imports, tuple(productions), tuple(sorted(problems))),
        heads=frozenset(heads if 2 * len(heads) > len(places) else ()),
    )


def _read_line(
    line: str, place: Position, problems: list[Problem], classes: EntityClasses
) -> Production | None:
    """Return the production of a line of a file; None where GPSRCmdGen leaves the line out."""
    match = _PRODUCTION.fullmatch(line)
    if match is not None and not match["expansion"].replace("|", " ").strip():
        problems.append(
            warning_at(
                place.shifted(match.start("expansion")),
                f"${match['head']} has no expansion here; the line is left out",
                "write {void} for no words, or remove the line",
            )
        )
        return None
    start = match.start("expansion") if match else len(line)
    if lone := lone_closing_parentheses(line[start:]):
        problems.append(
            warning_at(
                place.shifted(start + lone[0]),
                "no parenthesis opens what this ) at the end closes; it is left out",
                "remove it, or write \\) for the character itself",
            )
        )
        line = line[: start + lone[0]]
    return read_production(line, place, classes)


def read_production(
    line: str, position: Position | None = None, classes: EntityClasses | None = None
) -> Production:
    """Read one line ``$name = expansion`` without comments.

    Args:
        classes: those that wildcards may be of; None for any.

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
    reader = SymbolReader(match["expansion"], place.shifted(start), classes)
    expansion = reader.whole_line()
    head = place.shifted(match.start("head") - 1)
    require_name(match["head"], "nonterminal", MAX_NONTERMINAL, head)
    return Production(match["head"], expansion, head, tuple(reader.references))


def print_production(production: Production) -> str:
    """Return the line that reads back as an equal production."""
    return f"${production.nonterminal} = {print_sequence(production.expansion)}"
