"""Check a production while somebody writes it, and show what it would make."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any

from annotations.generation.assistance import utf16_index
from annotations.generation.world_consequences import WorldConsequences, consequences_of_lines
from annotations.language.forms import SymbolReader
from annotations.language.grammar import CHECK_STEPS, Budget, Grammar, readable
from annotations.language.templates import SemanticTemplate, SynchronousGrammar
from annotations.language.texts import LanguageError, Position, Problem
from annotations.models import Production, TaskCategory, World
from annotations.rows.composition import categories_to_write_for, plain_name, split_entry
from annotations.rows.from_rows import (
    Line,
    Lines,
    classes_of,
    composition_by_source,
    grammar_from,
    lines_of,
)

MOST_EXPANSIONS = 500  # looked at for samples
SHOWN_EXPANSIONS = 12
EXPANSION_FIELD = "expansion"  # what positions in the typed text are called


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

    @classmethod
    def of_stored(cls, row: Production) -> ProductionEdit:
        """Return the edit that leaves ``row`` as it is."""
        return cls(row.owning_world, row.source, row.nonterminal, row.expansion, row)

    def apply(self, lines: Lines) -> Lines:
        """Return the productions of the world after the change."""
        if self.row is None:
            return {**lines, self.source: [*lines.get(self.source, ()), self.line]}
        return self._replace(lines, [self.line])

    def delete(self, lines: Lines) -> Lines:
        """Return the productions of the world without the stored one."""
        return self._replace(lines, [])

    def _replace(self, lines: Lines, instead: list[Line]) -> Lines:
        row, mine = self.row, list(lines.get(self.source, ()))
        stored = row and (row.source, row.line, row.nonterminal, row.expansion)
        if stored in mine:
            at = mine.index(stored)
            mine[at : at + 1] = instead
        return {**lines, self.source: mine}

    def categories(self) -> Iterator[TaskCategory]:
        """Yield the task categories whose grammar has the file."""
        for category in categories_to_write_for(self.world, plain_name(self.source)):
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
    classes = classes_of(edit.world)
    reader = SymbolReader(edit.expansion, Position(EXPANSION_FIELD), classes)
    try:
        expansion = reader.whole_line()
    except LanguageError as error:
        return CheckedProduction((error.problem,))
    compared = _compare(edit, edit.apply)
    sizes = [GrammarSize(name, _size(before), _size(after)) for name, before, after in compared[1]]
    samples = next(filter(None, (_samples(after, expansion) for *_, after in compared[1])), [])
    return CheckedProduction(compared[0], tuple(samples), tuple(sizes))


def problems_without(edit: ProductionEdit) -> tuple[Problem, ...]:
    """Return the problems that the grammars have once the stored production is deleted, and not now."""
    return _compare(edit, edit.delete)[0]


def _compare(
    edit: ProductionEdit, change: Callable[[Lines], Lines]
) -> tuple[tuple[Problem, ...], list[tuple[str, Grammar, Grammar]]]:
    """Return the new problems, and the grammar of each task category that has the file now and then."""
    lines = lines_of(edit.world)
    changed = change(lines)
    problems: set[Problem] = set()
    grammars: list[tuple[str, Grammar, Grammar]] = []
    try:
        composition = composition_by_source(edit.world)
    except LanguageError:  # the line that cannot be read has its own problem
        composition = {}
    for category in edit.categories():
        try:
            before, after = grammar_from(category, lines), grammar_from(category, changed)
        except LanguageError as error:
            problems.add(error.problem)
            continue
        known = {each.message for each in before.problems()}
        problems |= {each for each in after.problems() if each.message not in known}
        problems |= set(_cycles_through_lines(category, after, composition))
        grammars.append((category.name, before, after))
    return tuple(sorted(problems)), grammars


def _cycles_through_lines(
    category: TaskCategory, grammar: Grammar, composition: Mapping[str, Sequence[SemanticTemplate]]
) -> Iterator[Problem]:
    """Yield the error of a grammar that is finite alone, but not with the lines of its nonterminals."""
    if any(problem.is_error for problem in grammar.problems()):
        return
    lines = tuple(
        line for source in category.template_sources for line in composition.get(source, ())
    )
    try:
        SynchronousGrammar(grammar, lines).words.require_finite()
    except LanguageError as error:
        yield error.problem


def consequences_of_production(edit: ProductionEdit) -> WorldConsequences:
    """Return what saving the production would do to the commands of its world."""
    return consequences_of_lines(edit.world, edit.apply(lines_of(edit.world)))


def assist_production(edit: ProductionEdit) -> dict[str, Any]:
    """Return what the editor shows while somebody types, as ``assist`` does for a template."""
    problems: list[dict[str, Any]] = []
    for problem in check_production(edit).problems:
        column = problem.position.column if problem.position.source == EXPANSION_FIELD else 1
        problems.append(
            {
                "field": EXPANSION_FIELD,
                "line": 1,
                "column": column,
                "at": utf16_index(edit.expansion, column - 1),
                "severity": str(problem.severity),
                "message": problem.message,
                "hint": problem.hint,
                "repairs": [],
            }
        )
    return {"problems": problems, "slots": []}


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
