"""Find the templates that derive a command, with their forms: the paper's grammar oracle.

Patterns of templates and of lines are rules of the same chart as the grammar (``recognizer``), so a grammar of
10¹² commands parses a sentence without being enumerated. What the chart matches is a packed forest: each rule
between two places keeps its best readings, and only as many as an ambiguity needs to show (Goodman, "Semiring
parsing", CL 1999; Huang and Chiang, "Better k-best parsing", IWPT 2005). So the work grows polynomially with
the grammar and the command. A reading says which arc of the lattice fills which slot.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple, TypeAlias

from annotations.language.forms import Constant, Form, Text, Wildcard, canonical_text, walk
from annotations.language.grammar import (
    Alternative,
    Arc,
    Budget,
    Chart,
    ChartRule,
    Expander,
    Lattice,
    RuleBook,
    Run,
    TooManyCombinations,
    intact,
)
from annotations.language.templates.composition import (
    Leaves,
    SynchronousGrammar,
    lines_of,
    names_in_order,
)
from annotations.language.templates.expansion import TaskCategory
from annotations.language.templates.filling import (
    Composed,
    Precedence,
    fill_anonymized,
    fill_intact,
    map_slots,
)
from annotations.language.templates.templates import SemanticTemplate
from annotations.language.texts import LanguageError

MOST_READINGS = 2  # of one rule between two places: two show an ambiguity
# What work costs in steps of a budget: filling a form and printing it; joining two readings.
STEPS_PER_FORM, STEPS_PER_JOIN = 300, 50


# The arcs that words are read by, in their order: one after the other of two paths, so that joining them is cheap.
Path: TypeAlias = "Arc | tuple[Path, Path] | tuple[()]"


@dataclass(frozen=True, slots=True)
class ChartDerivation:
    """One way to derive a command: the template of a task category and the form it gives.

    ``arcs`` are the numbers of the arcs that fill the class tokens of the form, in order; None for one that
    no arc with a number fills. ``path`` are the arcs of the lattice that it reads, ``cost`` is what they cost.
    """

    form_text: str
    task_category: str
    template_index: int
    arcs: tuple[int | None, ...] = ()
    cost: int = field(default=0, compare=False)
    path: tuple[Arc, ...] = field(default=(), compare=False)


class TemplateChart:
    """Parses anonymized commands, and lattices, with the templates of task categories.

    Raises:
        LanguageError: a grammar, or the lines of a task category, have a cycle.
    """

    def __init__(self, categories: Sequence[TaskCategory]) -> None:
        self._sets = [_TemplateSet(category) for category in categories]

    @property
    def rules(self) -> list[tuple[Sequence[ChartRule], int]]:
        """The rules of each task category, and which of them is a command."""
        return [(each.book.rules, each.root) for each in self._sets]

    @cached_property
    def vocabulary(self) -> frozenset[str]:
        """The words and class tokens of all commands."""
        return frozenset().union(*(each.vocabulary for each in self._sets))

    @cached_property
    def beginnings(self) -> frozenset[str]:
        """The words that commands begin with; none of a template that can begin with too many."""
        return frozenset().union(*(each.beginnings for each in self._sets))

    def spans(self, lattice: Lattice, budget: Budget | None = None) -> frozenset[tuple[int, int]]:
        """Return the places (start, end) between which a path is derived by some template.

        No form is made. So a span counts too whose words disagree about a nonterminal that stands twice;
        ``parse`` tells. Where the budget is spent, these are the spans that were found until then.
        """
        budget = budget or Budget()
        spans: set[tuple[int, int]] = set()
        try:
            for chart in self._sets:
                for span in chart.spans(lattice, budget):
                    spans.add(span)
        except TooManyCombinations:
            pass
        return frozenset(spans)

    def parse(self, command: str | Lattice, budget: Budget | None = None) -> list[ChartDerivation]:
        """Return derivations of a command, given as words between spaces or as a lattice; the best one is first.

        Those of the cheapest path come first. Among equals, categories come in their order and, inside one,
        later templates and later lines first, which is how ``generate`` resolves conflicts. A template has at
        most ``MOST_READINGS`` derivations. Empty if no template derives the command.

        Raises:
            TooManyCombinations: the budget is spent.
        """
        lattice = command if isinstance(command, Lattice) else Lattice.of_words(command.split())
        if not lattice.end:
            return []
        found = [each for chart in self._sets for each in chart.parse(lattice, budget or Budget())]
        return list(dict.fromkeys(sorted(found, key=lambda each: each.cost)))


class _TemplateSet:
    def __init__(self, category: TaskCategory) -> None:
        self.category = category
        self.rules = SynchronousGrammar(category.grammar, lines_of(category.templates))
        self.rules.words.require_finite()
        expander = Expander(self.rules.alternatives, intact)
        patterns = {
            name: tuple(line.pattern for line in lines)
            for name, lines in self.rules.lines_of.items()
        }
        self.book = RuleBook(expander, patterns)
        # The rule of each template of a whole command, and the choice among them, which finds those that can begin
        # with a word.
        self.roots: dict[int, tuple[int, _Rule]] = {}
        for index, template in enumerate(category.templates):
            if not template.nonterminal:
                rule = self.book.add_pattern(template.pattern)
                self.roots[rule] = index, _Rule(self, template, rule)
        self.root = self.book.add_choice(self.roots)
        self.lines = {
            rule: _Rule(self, line, rule, place)
            for name, rules in self.book.line_rules.items()
            for place, (rule, line) in enumerate(zip(rules, self.rules.lines_of[name], strict=True))
        }

    @property
    def vocabulary(self) -> frozenset[str]:
        return frozenset(
            word
            for rule in self.book.rules
            for alternative in rule.alternatives
            for item in alternative
            if isinstance(item, Run)
            for word in item.words
        )

    @property
    def beginnings(self) -> frozenset[str]:
        return frozenset().union(*(self.book.rules[rule].first or () for rule in self.roots))

    def spans(self, lattice: Lattice, budget: Budget) -> Iterator[tuple[int, int]]:
        chart = Chart(self.book, lattice, budget)
        for start in range(lattice.end):
            for end in chart.ends(self.root, start):
                if start < end:
                    yield start, end

    def parse(self, lattice: Lattice, budget: Budget) -> Iterator[ChartDerivation]:
        forest = _Forest(self, lattice, budget)
        chart = forest.chart
        possible = {item for (item,) in chart.candidates(self.root, 0)}
        for rule in reversed(self.roots):  # later templates first
            is_possible = rule in possible and chart.has_needed(rule)
            if is_possible and lattice.end in chart.ends(rule, 0):
                index, root = self.roots[rule]
                for form in forest.forms(root, 0, lattice.end):
                    text = canonical_text(form.anonymized)
                    yield ChartDerivation(
                        *(text, self.category.name, index, _arcs_of(form)),
                        *(form.cost, tuple(_arcs_on(form.path))),
                    )


class _Rule:
    """The rule of a template or a line, and what its form takes from its words.

    ``number`` is that in the rule book, ``line`` the place of a line among those of its nonterminal.
    """

    def __init__(
        self, owner: _TemplateSet, template: SemanticTemplate, number: int, line: int | None = None
    ) -> None:
        self.template = template
        self.number = number
        self.line = line
        self.names = names_in_order(template)
        self.tracked = template.tracked
        self.composed = frozenset(owner.rules.composed(template))
        self.wildcards = frozenset(
            each.name
            for each in template.slots()
            if isinstance(each, Wildcard) and each.entity_class
        )
        self.repeated = self.tracked & _repeated(owner.book, number)


@dataclass(frozen=True, slots=True)
class _Filled:
    """The form of a template or a line for some words: with class tokens, and with numbered arcs as slots.

    The two are one where no arc has a number.
    """

    anonymized: Form
    aligned: Form
    precedence: Precedence
    cost: int
    path: Path = field(default=(), compare=False)


# What a nonterminal became: a form, or the leaves that stand for its words. The number of a wildcard is its arc's.
Value: TypeAlias = "_Filled | Leaves"


class _Reading(NamedTuple):
    """One way to read what is between two places.

    ``bound`` are the values of the nonterminals that the form mentions, by name; ``slots`` the wildcards that
    stand for arcs, in order, with the numbers of these; ``inner`` those inside the nonterminals that are bound;
    ``leaves`` are kept inside a nonterminal whose words are wanted.
    """

    cost: int = 0
    bound: tuple[tuple[str, Value], ...] = ()
    slots: tuple[tuple[Wildcard, int], ...] = ()
    inner: tuple[tuple[Wildcard, int], ...] = ()
    leaves: Leaves = ()
    path: Path = ()

    @property
    def said(self) -> object:
        """All but the cost and the path: of two readings that say the same, the cheaper one counts."""
        return self.bound, self.slots, self.inner, self.leaves

    def read(self, arc: Arc, leaf: Text | Wildcard, is_slot: bool, keeps: bool) -> _Reading:
        """Return this reading with an arc after it, which reads a leaf of the grammar."""
        slots, leaves = self.slots, self.leaves
        if isinstance(leaf, Wildcard):
            has_number = arc.number >= 0
            if is_slot and has_number:
                slots = (*slots, (leaf, arc.number))
            # Its number in the grammar is none of an arc.
            leaf = replace(leaf, id=arc.number if has_number else None) if keeps else leaf
        if keeps:
            leaves = (*leaves, leaf)
        cost = self.cost + arc.cost
        return _Reading(cost, self.bound, slots, self.inner, leaves, (self.path, arc))

    def then(self, other: _Reading) -> _Reading | None:
        """Return both, one after the other; None where they disagree about the words of a nonterminal."""
        bound = self.bound or other.bound
        if self.bound and other.bound:
            values = dict(self.bound)
            for name, value in other.bound:
                if _words(values.setdefault(name, value)) != _words(value):
                    return None
            bound = tuple(sorted(values.items(), key=_name))
        return _Reading(
            self.cost + other.cost,
            bound,
            self.slots + other.slots,
            self.inner + other.inner,
            self.leaves + other.leaves,
            (self.path, other.path),
        )


_Reached: TypeAlias = "dict[int, list[_Reading]]"  # by where they end


class _Forest:
    """The readings of rules between places, for each template and each line that asks for them."""

    def __init__(self, owner: _TemplateSet, lattice: Lattice, budget: Budget) -> None:
        self.owner = owner
        self.lattice = lattice
        self.chart = Chart(owner.book, lattice, budget)
        self.budget = budget
        self._readings: dict[tuple[int, bool, int, int, int], list[_Reading]] = {}
        self._forms: dict[tuple[int, int, int], tuple[_Filled, ...]] = {}

    def forms(self, rule: _Rule, start: int, end: int) -> tuple[_Filled, ...]:
        """Return the best forms of a template or a line between two places, the best one first."""
        key = (rule.number, start, end)
        if key not in self._forms:
            filled: dict[Form, _Filled] = {}
            for reading in _ranked(rule, self._of_alternatives(rule, *key, keeps=False)):
                if len(reading.bound) == len(rule.tracked):
                    self.budget.spend(STEPS_PER_FORM)
                    form = _fill(rule, reading)
                    if form is not None:
                        filled.setdefault(form.aligned, form)
            self._forms[key] = tuple(filled.values())[:MOST_READINGS]
        return self._forms[key]

    def _of_rule(
        self, asker: _Rule, number: int, start: int, end: int, keeps: bool
    ) -> list[_Reading]:
        """Return the best readings of a rule between two places for the form of ``asker``.

        Args:
            keeps: whether the readings keep their leaves.
        """
        rule = self.chart.rules[number]
        is_asked = not asker.tracked.isdisjoint(rule.names)
        is_filled = not asker.wildcards.isdisjoint(rule.wildcards)
        # All that ask for nothing inside share their readings.
        shared = asker.number if is_asked or is_filled else -1
        key = (shared, keeps, number, start, end)
        if key in self._readings:
            return self._readings[key]
        if rule.name in asker.composed:
            lines = [self.owner.lines[line] for line in self.owner.book.line_rules[rule.name]]
            readings = [
                _Reading(form.cost, ((rule.name, form),), path=form.path)
                for line in lines
                if end in self.chart.ends(line.number, start)
                for form in self.forms(line, start, end)
            ]
        elif rule.name in asker.tracked:
            readings = []
            for inside in self._of_alternatives(asker, number, start, end, keeps=True):
                bound = (*inside.bound, (rule.name, inside.leaves))
                readings.append(
                    _Reading(
                        inside.cost,
                        tuple(sorted(bound, key=_name)),
                        inner=inside.slots + inside.inner,
                        leaves=inside.leaves if keeps else (),
                        path=inside.path,
                    )
                )
        else:
            readings = self._of_alternatives(asker, number, start, end, keeps)
        # A nonterminal that stands only here, and is not bound here, is bound nowhere.
        needed = (asker.tracked & rule.names) - asker.repeated
        if needed:
            readings = [each for each in readings if needed <= {name for name, _ in each.bound}]
        self._readings[key] = _best(asker, readings)
        return self._readings[key]

    def _of_alternatives(
        self, asker: _Rule, number: int, start: int, end: int, keeps: bool
    ) -> list[_Reading]:
        readings: list[_Reading] = []
        for alternative in self.chart.candidates(number, start):
            readings += self._through(asker, alternative, start, end, keeps)
        return readings

    def _through(
        self, asker: _Rule, alternative: Alternative, start: int, end: int, keeps: bool
    ) -> list[_Reading]:
        """Return the readings of the items of an alternative, one after the other."""
        reached: _Reached = {start: [_Reading()]}
        for item in alternative:
            if isinstance(item, int):
                reached = self._through_rule(asker, item, reached, end, keeps)
                continue
            for leaf in item.leaves:
                reached = self._through_leaf(asker, leaf, reached, end, keeps)
        return reached.get(end, [])

    def _through_rule(
        self, asker: _Rule, rule: int, reached: _Reached, end: int, keeps: bool
    ) -> _Reached:
        following: defaultdict[int, list[_Reading]] = defaultdict(list)
        for place, before in reached.items():
            for stop in self.chart.ends(rule, place):
                if stop <= end:
                    readings = self._of_rule(asker, rule, place, stop, keeps)
                    self.budget.spend(STEPS_PER_JOIN * len(before) * len(readings))
                    joined = (one.then(other) for one in before for other in readings)
                    following[stop] += (each for each in joined if each is not None)
        return {place: _best(asker, each) for place, each in following.items()}

    def _through_leaf(
        self, asker: _Rule, leaf: Text | Wildcard, reached: _Reached, end: int, keeps: bool
    ) -> _Reached:
        word = leaf.value if isinstance(leaf, Text) else leaf.token
        is_slot = isinstance(leaf, Wildcard) and leaf.name in asker.wildcards
        following: defaultdict[int, list[_Reading]] = defaultdict(list)
        for place, before in reached.items():
            for arc in self.lattice.arcs(place, word):
                if arc.end <= end:
                    self.budget.spend(STEPS_PER_JOIN * len(before))
                    following[arc.end] += (one.read(arc, leaf, is_slot, keeps) for one in before)
        return {place: _best(asker, each) for place, each in following.items()}


def _best(asker: _Rule, readings: list[_Reading]) -> list[_Reading]:
    """Return the best readings that say different things, the best one first.

    Those that bind other nonterminals, or a nonterminal that comes again with other words, are no rivals: one of
    them may be of no use further up.
    """
    if len(readings) <= 1:
        return readings
    groups: defaultdict[object, dict[object, _Reading]] = defaultdict(dict)
    for reading in _ranked(asker, readings):
        names = tuple(name for name, _ in reading.bound)
        again = tuple(_words(value) for name, value in reading.bound if name in asker.repeated)
        rivals = groups[names, again]
        if len(rivals) < MOST_READINGS:
            rivals.setdefault(reading.said, reading)
    return [reading for rivals in groups.values() for reading in rivals.values()]


def _ranked(asker: _Rule, readings: Iterable[_Reading]) -> list[_Reading]:
    """Return the readings with the cheapest first and, among equals, those with the greatest precedence."""

    def rank(reading: _Reading) -> tuple[object, ...]:
        values = dict(reading.bound)
        precedence = tuple((name, _words(values[name])) for name in asker.names if name in values)
        return -reading.cost, precedence

    return sorted(readings, key=rank, reverse=True)


def _words(value: Value) -> Precedence:
    """Return what tells two values of a nonterminal apart: the precedence of a form, or the words."""
    if isinstance(value, _Filled):
        return value.precedence
    return tuple(leaf.value if isinstance(leaf, Text) else leaf.token for leaf in value)


def _is_plain(value: Value) -> bool:
    """Return whether no arc with a number is in a value."""
    if isinstance(value, _Filled):
        return value.aligned is value.anonymized
    return not any(isinstance(leaf, Wildcard) and leaf.id is not None for leaf in value)


def _fill(rule: _Rule, reading: _Reading) -> _Filled | None:
    """Return the form of a template for a reading; None where the words for a predicate are no name."""
    values = dict(reading.bound)
    form = rule.template.form
    is_plain = not (reading.slots or reading.inner) and all(map(_is_plain, values.values()))
    try:
        anonymized = aligned = fill_anonymized(
            form,
            {
                name: Composed(value.anonymized, ())
                if isinstance(value, _Filled)
                else _words(value)
                for name, value in values.items()
            },
        )
        if not is_plain:
            aligned = fill_intact(
                map_slots(form, _SlotArcs(reading).of),
                {
                    name: Composed(value.aligned, ()) if isinstance(value, _Filled) else value
                    for name, value in values.items()
                },
            )
    except LanguageError:
        return None
    inner = tuple(_words(values[name]) for name in rule.names)
    precedence: Precedence = inner if rule.line is None else (rule.line, *inner)
    return _Filled(anonymized, aligned, precedence, reading.cost, reading.path)


class _SlotArcs:
    """Finds the arc of a form's wildcard: that of its number, or that of the next one in the command.

    The nonterminals that the form mentions have theirs for themselves, unless there is no other.
    """

    def __init__(self, reading: _Reading) -> None:
        slots = (*reading.slots, *reading.inner)
        self._numbered = {wildcard.identity: arc for wildcard, arc in reversed(slots)}
        self._others = _without_number(reading.inner) | _without_number(reading.slots)
        self._turns: Counter[str] = Counter()

    def of(self, wildcard: Wildcard) -> Wildcard:
        """Return the wildcard with the number of its arc, or without a number where there is none."""
        if wildcard.id is not None:
            return replace(wildcard, id=self._numbered.get(wildcard.identity))
        arcs = self._others.get(wildcard.name, [])
        turn = self._turns[wildcard.name]
        self._turns[wildcard.name] += 1
        return replace(wildcard, id=arcs[min(turn, len(arcs) - 1)] if arcs else None)


def _without_number(slots: Iterable[tuple[Wildcard, int]]) -> dict[str, list[int]]:
    arcs: defaultdict[str, list[int]] = defaultdict(list)
    for wildcard, arc in slots:
        if wildcard.id is None:
            arcs[wildcard.name].append(arc)
    return dict(arcs)


def _arcs_of(form: _Filled) -> tuple[int | None, ...]:
    """Return the arc of each class token of the form, in order; nothing where none has one."""
    if _is_plain(form):
        return ()
    pairs = zip(walk(form.anonymized), walk(form.aligned), strict=True)
    arcs = tuple(
        aligned.id if isinstance(aligned, Wildcard) else None
        for token, aligned in pairs
        if isinstance(token, Constant) and token.token_class
    )
    return () if set(arcs) == {None} else arcs


def _repeated(book: RuleBook, rule: int) -> frozenset[str]:
    """Return the nonterminals that can stand more than once in what a rule becomes."""
    repeated: set[str] = set()
    seen: set[int] = set()
    waiting = [rule]
    while waiting:
        number = waiting.pop()
        if number in seen:
            continue
        seen.add(number)
        for alternative in book.rules[number].alternatives:
            rules = [item for item in alternative if isinstance(item, int)]
            counts = Counter(name for item in rules for name in book.rules[item].names)
            repeated.update(name for name, count in counts.items() if count > 1)
            waiting += rules
    return frozenset(repeated)


def _arcs_on(path: Path) -> Iterator[Arc]:
    waiting = [path]
    while waiting:
        match waiting.pop():
            case Arc() as arc:
                yield arc
            case (first, second):
                waiting += [second, first]


def _name(binding: tuple[str, Value]) -> str:
    return binding[0]
