"""Checks a production while somebody writes it, and shows what it would make."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from typing import Any

from annotations.editing.assistance import utf16_index
from annotations.generation.consequences import WorldConsequences, consequences_of_lines
from annotations.language.errors import LanguageError, Position, Problem
from annotations.language.grammar import CHECK_STEPS, Budget, Grammar, readable
from annotations.language.symbols import SymbolReader
from annotations.models import Production, TaskCategory, World
from annotations.rows.composition import split_entry
from annotations.rows.from_rows import Line, Lines, grammar_from, lines_of

MOST_EXPANSIONS = 500  # looked at for samples
SHOWN_EXPANSIONS = 12
FIELD = "expansion"  # what positions in the typed text are called


@dataclass(frozen=True)
class ProductionEdit:
    """A production as it would be saved; ``row`` is the stored one, None where it is new."""

    world: World
    source: str
    nonterminal: str
    expansion: str
    row: Production | None = None

    @property
    def line(self) -> Line:
        return self.source, self.row.line if self.row else 0, self.nonterminal, self.expansion

    def apply(self, lines: Lines) -> Lines:
        """Return the productions of the world after the change."""
        mine = list(lines.get(self.source, ()))
        if self.row is None:
            return {**lines, self.source: [*mine, self.line]}
        stored = (self.row.source, self.row.line, self.row.nonterminal, self.row.expansion)
        if stored in mine:
            mine[mine.index(stored)] = self.line
        return {**lines, self.source: mine}

    def categories(self) -> Iterator[TaskCategory]:
        """Yield the task categories whose grammar has the file."""
        for category in TaskCategory.objects.filter(grammar__world=self.world):
            if self.source in [split_entry(entry)[0] for entry in category.rule_sources]:
                yield category


@dataclass(frozen=True)
class GrammarSize:
    """How many commands the grammar of a task category makes, at most, now and then."""

    task_category: str
    before: str
    after: str


@dataclass(frozen=True)
class CheckedProduction:
    """``problems`` are those of the text and those that the grammars have not got without it."""

    problems: tuple[Problem, ...]
    samples: tuple[str, ...] = ()
    sizes: tuple[GrammarSize, ...] = ()

    @property
    def has_errors(self) -> bool:
        return any(problem.is_error for problem in self.problems)


def check_production(edit: ProductionEdit) -> CheckedProduction:
    """Read the expansion, check the grammars that have it, and expand some of it."""
    reader = SymbolReader(edit.expansion, Position(FIELD))
    try:
        expansion = reader.whole_line()
    except LanguageError as error:
        return CheckedProduction((error.problem,))
    lines = lines_of(edit.world)
    changed = edit.apply(lines)
    problems: set[Problem] = set()
    sizes: list[GrammarSize] = []
    samples: list[str] = []
    for category in edit.categories():
        try:
            before, after = grammar_from(category, lines), grammar_from(category, changed)
        except LanguageError as error:
            problems.add(error.problem)
            continue
        known = {each.message for each in before.problems()}
        problems |= {each for each in after.problems() if each.message not in known}
        sizes.append(GrammarSize(category.name, _size(before), _size(after)))
        samples = samples or _samples(after, expansion)
    return CheckedProduction(tuple(sorted(problems)), tuple(samples), tuple(sizes))


def consequences_of_production(edit: ProductionEdit) -> WorldConsequences:
    """Return what saving the production would do to the commands of its world."""
    return consequences_of_lines(edit.world, edit.apply(lines_of(edit.world)))


def assist_production(edit: ProductionEdit) -> dict[str, Any]:
    """Return what the editor shows while somebody types, as ``assist`` does for a template."""
    problems = check_production(edit).problems
    return {"problems": [_as_json(each, edit) for each in problems], "slots": []}


def _as_json(problem: Problem, edit: ProductionEdit) -> dict[str, Any]:
    column = problem.position.column if problem.position.source == FIELD else 1
    return {
        "field": FIELD,
        "line": 1,
        "column": column,
        "at": utf16_index(edit.expansion, column - 1),
        "severity": str(problem.severity),
        "message": problem.message,
        "hint": problem.hint,
        "repairs": [],
    }


def _size(grammar: Grammar) -> str:
    try:
        return readable(grammar.size())
    except LanguageError:
        return "unknown"


def _samples(grammar: Grammar, expansion: Any) -> list[str]:
    """Return some of what the expansion becomes, from all over it."""
    try:
        stream = grammar.expander.stream(expansion, Budget(CHECK_STEPS))
        texts = list(dict.fromkeys(" ".join(words) for words, _ in islice(stream, MOST_EXPANSIONS)))
    except LanguageError:
        return []
    step = max(1, len(texts) // SHOWN_EXPANSIONS)
    return texts[::step][:SHOWN_EXPANSIONS]
