"""What templates of the grammars in use expand to, kept by this process."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import replace

from annotations.language.grammar import Budget, Grammar, readable
from annotations.language.templates import (
    DEFAULT_LIMIT,
    BoundedCache,
    Generated,
    GrammarExpansions,
    SemanticTemplate,
    TaskCategory,
    TemplateChecker,
    generate,
    generation_size,
)
from annotations.language.texts import LanguageError, Problem
from annotations.language.world import Predicate

# Pairs of a world that a request brings up to date: about two seconds on one core (docs/design/generation.md).
MOST_AT_ONCE = 30_000
STEPS_AT_ONCE = 10_000_000

# Pairs of one grammar, about 200 bytes each: 12 grammars take at most 100 MB.
MOST_PAIRS = 40_000
Lines = tuple[SemanticTemplate, ...]
_EXPANSIONS: BoundedCache[Hashable, GrammarExpansions] = BoundedCache(12)
# A world before and after a change: 100 bytes a command.
_GENERATED: BoundedCache[Hashable, Generated] = BoundedCache(
    4 * MOST_AT_ONCE, lambda generated: len(generated.expansions)
)


class _Checks:
    """The checker of a grammar, and what it said. It holds the grammar, whose identity is part of the key."""

    def __init__(self, grammar: Grammar, lines: Lines) -> None:
        expansions = expansions_of(grammar, lines)
        self.checker = TemplateChecker(grammar, expansions.expander, expansions)
        self.problems: BoundedCache[Hashable, tuple[Problem, ...]] = BoundedCache(5_000)


_CHECKS: BoundedCache[Hashable, _Checks] = BoundedCache(12)


def expansions_of(grammar: Grammar, lines: Lines = ()) -> GrammarExpansions:
    """Return what this process keeps of ``grammar`` with the ``lines`` of its nonterminals.

    The same value is asked for again while ``annotations.rows.from_rows`` keeps it, so that its identity
    stands for its content.
    """
    return _EXPANSIONS.get(
        _key(grammar, lines), lambda: GrammarExpansions(grammar, lines, MOST_PAIRS)
    )


def _key(grammar: Grammar, lines: Lines) -> Hashable:
    return id(grammar), tuple(line.texts for line in lines)


def generate_at_once(categories: Sequence[TaskCategory]) -> Generated:
    """Return what ``generate`` does, for somebody who waits: only what is not kept is worked out.

    Raises:
        LanguageError: the templates make more than ``MOST_AT_ONCE`` commands, or as ``generate``.
    """
    content = tuple(
        (
            category.name,
            category.grammar.productions,
            tuple(template.texts for template in category.templates),
        )
        for category in categories
    )
    return _GENERATED.get(content, lambda: _generate(categories))


def _generate(categories: Sequence[TaskCategory]) -> Generated:
    size = generation_size(categories, expansions=expansions_of)
    if size > MOST_AT_ONCE:
        raise LanguageError(f"this world makes up to {readable(size)} commands")
    return generate(categories, expansions=expansions_of, budget=Budget(STEPS_AT_ONCE))


def checker_of(
    grammar: Grammar,
    predicates: Mapping[str, Predicate],
    task_category: str,
    lines: Lines = (),
    limit: int | None = DEFAULT_LIMIT,
) -> TemplateChecker:
    """Return a checker of ``grammar`` with ``lines``, whose rules are compiled once.

    ``limit`` is as in ``TemplateChecker``. Raises as ``template_checker``.
    """
    checker = _checks_of(grammar, lines).checker
    return replace(checker, predicates=predicates, task_category=task_category, limit=limit)


def problems_of(
    checker: TemplateChecker, template: SemanticTemplate, budget: Budget | None = None
) -> tuple[Problem, ...]:
    """Return what ``checker`` says of ``template`` within ``budget``; the same texts are checked once.

    Raises:
        LanguageError: the grammar has a cycle.
    """
    predicates = tuple((checker.predicates or {}).values())
    key = (predicates, checker.task_category, checker.limit, template.texts)
    kept = _checks_of(checker.grammar, checker.expander.rules.lines).problems
    return kept.get(key, lambda: checker.problems(template, budget))


def _checks_of(grammar: Grammar, lines: Lines) -> _Checks:
    return _CHECKS.get(_key(grammar, lines), lambda: _Checks(grammar, lines))
