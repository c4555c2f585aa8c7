"""Which commands of the grammar have no form yet, by task category and nonterminal."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

from annotations import models
from annotations.generation.coverage import known_commands
from annotations.language.grammar import Budget, Grammar, passages
from annotations.language.templates import BoundedCache
from annotations.language.texts import LanguageError, Position, Problem, warning_at
from annotations.rows.from_rows import task_categories

# Derivations of one task category that a page looks at: about a fifth of a second of processor time.
MOST_LOOKED_AT = 20_000
MOST_STEPS = 5_000_000
# Grammar → its commands with their nonterminals, as ``passages`` gives them. The grammar is kept with them, so that its
# identity stands for its content.
_PASSAGES: BoundedCache[int, tuple[Grammar, Mapping[str, frozenset[str]]]] = BoundedCache(
    3 * MOST_LOOKED_AT, lambda kept: len(kept[1])
)


@dataclass(frozen=True, slots=True)
class UncoveredCommand:
    """A command without a form; ``nonterminals`` are those that a derivation of it goes through."""

    text: str
    task_category: str
    nonterminals: frozenset[str]


@dataclass(frozen=True, slots=True)
class NonterminalCoverage:
    """How many of the commands that go through a nonterminal have a form."""

    nonterminal: str
    commands: int
    uncovered: int

    @property
    def covered_percent(self) -> float:
        return 100 * (self.commands - self.uncovered) / self.commands


@dataclass(frozen=True)
class UncoveredReport:
    """The commands without a form, and the share of each nonterminal that has such commands, worst first.

    ``cut`` are the task categories of which only the first ``MOST_LOOKED_AT`` derivations were looked at;
    ``problems`` say why one could not be looked at.
    """

    commands: tuple[UncoveredCommand, ...]
    shares: tuple[NonterminalCoverage, ...]
    cut: tuple[str, ...] = ()
    problems: tuple[Problem, ...] = field(default=())

    def matching(self, nonterminal: str = "", text: str = "") -> list[UncoveredCommand]:
        """Return the commands that go through ``nonterminal`` and say ``text``, whatever its case."""
        said = " ".join(text.lower().split())
        return [
            command
            for command in self.commands
            if (not nonterminal or nonterminal in command.nonterminals)
            and said in command.text.lower()
        ]


def uncovered_of(world: models.World, task_category: str = "") -> UncoveredReport:
    """Compare what the grammar derives with the commands that have a form, of one task category or all."""
    try:
        categories = task_categories(world)
    except LanguageError as error:
        return UncoveredReport((), (), problems=(error.problem,))
    covered = known_commands(world)
    if covered is None:
        said = f"the commands are {world.sample_note}, so nobody knows which others have no form"
        hint = "generate all commands, where these are not too many"
        return UncoveredReport((), (), problems=(warning_at(Position(), said, hint),))
    chosen = [each for each in categories if task_category in ("", each.name)]
    commands: list[UncoveredCommand] = []
    all_of, without_form = Counter[str](), Counter[str]()
    cut: list[str] = []
    problems: list[Problem] = []
    for category in chosen:
        try:
            through = _passages(category.grammar)
            is_cut = category.grammar.size() > MOST_LOOKED_AT
        except LanguageError as error:
            problems.append(error.problem)
            continue
        cut.extend([category.name] * is_cut)
        missing = [
            UncoveredCommand(command, category.name, nonterminals)
            for command, nonterminals in through.items()
            if command not in covered
        ]
        commands += missing
        all_of.update(name for names in through.values() for name in names)
        without_form.update(name for each in missing for name in each.nonterminals)
    shares = [
        NonterminalCoverage(name, all_of[name], count) for name, count in without_form.items()
    ]
    shares.sort(key=lambda share: (share.covered_percent, -share.uncovered, share.nonterminal))
    return UncoveredReport(tuple(commands), tuple(shares), tuple(cut), tuple(problems))


def next_uncovered(
    world: models.World, category: str, command: str, made: Collection[str] = ()
) -> UncoveredCommand | None:
    """Return the command without a form that follows ``command`` in its task category, or else the first one.

    Those of the other task categories come when this one has none left.

    Args:
        made: commands that count as having a form, whether or not they are generated yet.
    """
    order = _order_of_commands(world, category)
    at = order.get(command, -1)
    left = (
        (each.task_category != category, order.get(each.text, 0) <= at, place, each)
        for place, each in enumerate(uncovered_of(world).commands)
        if each.text != command and each.text not in made
    )
    first = min(left, default=None)
    return first[-1] if first else None


def _order_of_commands(world: models.World, category: str) -> Mapping[str, int]:
    """Return the place of each command of a task category, those with a form included."""
    try:
        grammars = {each.name: each.grammar for each in task_categories(world)}
        commands = _passages(grammars[category]) if category in grammars else ()
    except LanguageError:
        return {}
    return {command: place for place, command in enumerate(commands)}


def _passages(grammar: Grammar) -> Mapping[str, frozenset[str]]:
    def make() -> tuple[Grammar, Mapping[str, frozenset[str]]]:
        return grammar, passages(grammar, Budget(MOST_STEPS), MOST_LOOKED_AT)

    return _PASSAGES.get(id(grammar), make)[1]
