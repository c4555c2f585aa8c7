"""Lengthen what a world says already: a phrase in the place of another one of a stored template is one more for it.

A command that differs from the commands of a template in one place alone, and means the same, adds what it says there:
to the nonterminal that stands there, to the choice, or to a nonterminal that is made of the words. The template, and
the production that says the same, are changed then, and no further template is needed.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import islice
from typing import Literal, TypeAlias

from annotations.language.forms import (
    Choice,
    Nonterminal,
    Symbols,
    Text,
    Wildcard,
    canonical_text,
    head_predicate,
    print_sequence,
    print_symbol,
    walk_symbols,
)
from annotations.language.grammar import (
    CHECK_STEPS,
    Budget,
    Chart,
    Grammar,
    Lattice,
    Production,
    RuleBook,
    TooManyCombinations,
    print_production,
)
from annotations.language.induction.rules import (
    Rule,
    Words,
    articles_varied,
    is_slot,
    phrase_symbols,
    says_something,
    with_tokens,
)
from annotations.language.induction.synonyms import Synonyms, free_name, with_nonterminals
from annotations.language.templates import (
    SemanticTemplate,
    SynchronousGrammar,
    TaskCategory,
    TemplateChart,
    make_template,
)

MOST_PHRASES = 60  # of a nonterminal whose words new templates use

Kind: TypeAlias = Literal["production", "template"]


@dataclass(frozen=True, slots=True)
class Edit:
    """A stored line as it is and as it becomes; ``was`` is None for a production that is added.

    ``source`` is the file or set that it stands in.
    """

    was: Production | SemanticTemplate | None
    becomes: Production | SemanticTemplate
    source: str

    @property
    def kind(self) -> Kind:
        return "production" if isinstance(self.becomes, Production) else "template"

    @property
    def stored(self) -> dict[str, str]:
        """The fields of the line as it becomes."""
        if isinstance(self.becomes, Production):
            expansion = print_sequence(self.becomes.expansion)
            return {"nonterminal": self.becomes.nonterminal, "expansion": expansion}
        return {"pattern": self.becomes.pattern_text}

    @property
    def before(self) -> str:
        return _line(self.was) if self.was is not None else ""

    @property
    def after(self) -> str:
        return _line(self.becomes)


@dataclass(frozen=True, slots=True)
class Change:
    """``phrases`` that may be said where ``old`` stands, such as ``$water`` or ``water``, and what that changes.

    ``name`` is that of the nonterminal, empty for a choice. ``lines`` are those that say so; each of ``comments`` is
    the line that refuses one of the phrases. ``templates`` counts the templates that say ``old``.
    """

    name: str
    old: str
    phrases: tuple[str, ...]
    edits: tuple[Edit, ...]
    lines: tuple[int, ...]
    comments: tuple[str, ...]
    templates: int


@dataclass(frozen=True, slots=True)
class Spot:
    """Where a command says something else than a template: ``phrase`` for ``old``, which are symbols of its pattern.

    ``index`` is that of the template in its task category, ``said`` the command as the template may say it.
    """

    category: TaskCategory
    index: int
    old: Symbols
    phrase: Words
    said: Words

    @property
    def template(self) -> SemanticTemplate:
        return self.category.templates[self.index]

    @property
    def head(self) -> str:
        return head_predicate(self.template.form)

    @property
    def name(self) -> str:
        """The nonterminal that stands there; empty where something else does."""
        only = self.old[0] if len(self.old) == 1 else None
        return only.name if isinstance(only, Nonterminal) else ""

    @property
    def key(self) -> object:
        """What places have in common that are lengthened together."""
        if self.name:
            return self.name, self.category.name
        if isinstance(self.old[0], Choice):
            return self.old, self.template.pattern
        return self.old, self.head, self.category.name

    def alike(
        self, categories: Iterable[TaskCategory]
    ) -> Iterator[tuple[TaskCategory, SemanticTemplate]]:
        """Yield the templates that change with it: those of its predicate, and with a choice those of its pattern."""
        is_choice = isinstance(self.old[0], Choice)
        for category in categories:
            for each in category.templates:
                is_same = each.pattern == self.template.pattern
                is_of_head = not is_choice and head_predicate(each.form) == self.head
                if each.nonterminal or not (is_same or is_of_head):
                    continue
                if _exchanged(each.pattern, self.old, Text("")) != each.pattern:
                    yield category, each

    @property
    def refusal(self) -> frozenset[str]:
        """What somebody says not to be one who refuses the phrase here."""
        return frozenset((_named(" ".join(self.phrase)), _named(print_sequence(self.old))))

    @property
    def comment(self) -> str:
        """The line that says so."""
        return f"# {_named(' '.join(self.phrase))} is not {_named(print_sequence(self.old))}"

    @property
    def size(self) -> tuple[int, bool]:
        """How much differs. Of two that are equal, the one where words vary already comes first."""
        return len(self.old) + len(self.phrase), isinstance(self.old[0], Text)


@dataclass(frozen=True, slots=True)
class Extension:
    """``left`` are the commands that lengthen nothing; ``written`` are they with the words that vary in the world."""

    changes: tuple[Change, ...] = ()
    left: tuple[Rule, ...] = ()
    written: Mapping[Rule, Sequence[int]] = field(default_factory=dict)


class StoredTemplates:
    """The templates of task categories, to lay commands beside.

    Raises:
        LanguageError: a grammar, or the lines of a task category, have a cycle.
    """

    def __init__(self, categories: Sequence[TaskCategory]) -> None:
        self.categories = tuple(categories)
        self.chart = TemplateChart(categories)

    @cached_property
    def _sets(self) -> tuple[_Set, ...]:
        return tuple(map(_Set, self.categories))

    def spots(self, words: Words, head: str, budget: Budget) -> list[Spot]:
        """Return where a command may differ from the templates of ``head`` in one place, the smallest places first.

        ``head`` is empty for any. Empty where the budget does not suffice.
        """
        try:
            found = [each for some in self._sets for each in some.spots(words, head, budget)]
        except TooManyCombinations:
            return []
        return sorted(found, key=lambda each: each.size)

    def form_at(self, spot: Spot, budget: Budget) -> str:
        """Return the form of a command with what its template says at a spot; empty where it has none."""
        try:
            found = self.chart.parse(" ".join(spot.said), budget)
        except TooManyCombinations:
            return ""
        own = (spot.category.name, spot.index)
        forms = (e.form_text for e in found if (e.task_category, e.template_index) == own)
        return next(forms, "")

    def words_of(self, name: str) -> Iterator[Synonyms]:
        """Yield the nonterminals of the task category ``name`` that become words alone and stand in its templates."""
        for each in self._sets:
            if each.name == name:
                yield from each.synonyms()


class _Set:
    """The templates of one task category: what each symbol of their patterns becomes, as rules of a rule book."""

    def __init__(self, category: TaskCategory) -> None:
        self.category = category
        self.name = category.name
        self.rules = SynchronousGrammar(category.grammar, category.lines)
        self.expander = self.rules.words.expander
        self.book = RuleBook(self.expander)
        self.templates: defaultdict[str, list[_Laid]] = defaultdict(list)
        for index, template in enumerate(category.templates):
            if not template.nonterminal:
                laid = _Laid(index, template, self)
                self.templates[head_predicate(template.form)].append(laid)

    def spots(self, words: Words, head: str, budget: Budget) -> Iterator[Spot]:
        """Yield where a command may differ from the templates of ``head``, which is empty for any."""
        chart = Chart(self.book, Lattice.of_words(words), budget)
        slots = frozenset(filter(is_slot, words))
        for name in [head] if head else list(self.templates):
            for laid in self.templates.get(name, ()):
                if slots <= laid.tokens:
                    yield from laid.spots(words, chart)

    def synonyms(self) -> Iterator[Synonyms]:
        heads: defaultdict[str, set[str]] = defaultdict(set)
        for head, templates in self.templates.items():
            for template in (each.template for each in templates):
                for symbol in walk_symbols(template.pattern, notes=False):
                    if isinstance(symbol, Nonterminal) and self.are_words(template, (symbol,)):
                        heads[symbol.name].add(head)
        for name, of_heads in heads.items():
            some = islice(self.expander.stream((Nonterminal(name),)), MOST_PHRASES)
            phrases = tuple(dict.fromkeys(words for words, _ in some))
            if all(map(_may_stand, phrases)):
                yield Synonyms(name, phrases, frozenset(of_heads), holds_everywhere=False)

    def leaves(self, symbols: Symbols) -> Iterator[Text | Wildcard]:
        names: set[str] = set()
        for symbol in walk_symbols(symbols, notes=False):
            if isinstance(symbol, Nonterminal):
                names |= self.rules.words.reachable(symbol.name)
            else:
                yield symbol
        for name in names:
            for alternative in self.rules.words.alternatives(name):
                for symbol in walk_symbols(alternative, notes=False):
                    if not isinstance(symbol, Nonterminal):
                        yield symbol

    def are_words(self, template: SemanticTemplate, symbols: Symbols) -> bool:
        """Return whether symbols of a template become words alone, and say nothing in its form."""
        names = {
            each.name
            for each in walk_symbols(symbols, notes=False)
            if isinstance(each, Nonterminal)
        }
        reached = frozenset[str]().union(*map(self.rules.words.reachable, names))
        return (
            reached.isdisjoint(template.tracked)
            and reached.isdisjoint(self.rules.lines_of)
            and all(isinstance(each, Text) for each in self.leaves(symbols))
        )

    def words_for(self, symbols: Symbols) -> Words:
        """Return some words that say something and that symbols become; none where there are none."""
        found = (words for words, _ in islice(self.expander.stream(symbols), MOST_PHRASES))
        return next(filter(_may_stand, found), ())


class _Laid:
    """A template, each symbol of its pattern as a rule of the book, and what may be said there."""

    def __init__(self, index: int, template: SemanticTemplate, owner: _Set) -> None:
        self.index, self.template, self.owner = index, template, owner
        self.rules = [owner.book.add_pattern((symbol,)) for symbol in template.pattern]
        leaves = owner.leaves(template.pattern)
        self.tokens = frozenset(each.token for each in leaves if isinstance(each, Wildcard))
        self._words: dict[tuple[int, int], Words] = {}

    def spots(self, words: Words, chart: Chart) -> Iterator[Spot]:
        behind = self._behind(chart)
        before = frozenset((0,))
        for start, rule in enumerate(self.rules):
            for end in range(start + 1, len(self.rules) + 1):
                if not (behind[end] and (said := self._said(start, end))):
                    continue
                for first in before:
                    for last in behind[end]:
                        if _may_stand(phrase := words[first:last]):
                            old = self.template.pattern[start:end]
                            command = (*words[:first], *said, *words[last:])
                            yield Spot(self.owner.category, self.index, old, phrase, command)
            before = frozenset().union(*(chart.ends(rule, place) for place in before))
            if not before:
                break

    def _behind(self, chart: Chart) -> list[frozenset[int]]:
        """Return for each symbol, and behind the last, the places from where the rest of the command is derived."""
        behind = [frozenset((chart.lattice.end,))]
        for rule in reversed(self.rules):
            places = range(max(behind[0]) + 1) if behind[0] else ()
            behind.insert(0, frozenset(n for n in places if chart.ends(rule, n) & behind[0]))
        return behind

    def _said(self, start: int, end: int) -> Words:
        """Return some words for the symbols between two places; none where they are more than words."""
        if (start, end) not in self._words:
            old = self.template.pattern[start:end]
            are_words = self.owner.are_words(self.template, old)
            self._words[start, end] = self.owner.words_for(old) if are_words else ()
        return self._words[start, end]


def _may_stand(phrase: Words) -> bool:
    return any(map(says_something, phrase)) and not any(map(is_slot, phrase))


def _named(text: str) -> str:
    return f"[{text}]" if " " in text else text


def extend(
    stored: StoredTemplates,
    category: str,
    rules: Mapping[Rule, Sequence[int]],
    given: Collection[Rule],
    refused: Collection[frozenset[str]],
    taken: Collection[str],
) -> Extension:
    """Lengthen what is stored by the commands that differ from it in one place.

    Args:
        category: the task category that new templates go to, which use its words that vary.
        rules: commands that the templates do not have, with their lines.
        given: those of them whose form somebody has written.
        refused: the pairs of phrases that are said not to be one.
        taken: the names of nonterminals that are not free.
    """
    budget = Budget(CHECK_STEPS)
    spots: defaultdict[object, list[tuple[Spot, Sequence[int]]]] = defaultdict(list)
    left: dict[Rule, Sequence[int]] = {}
    for rule, lines in rules.items():
        means = canonical_text(with_tokens(rule.form)) if rule in given else ""
        spot = _best_spot(stored, rule, means, refused, budget)
        if spot is None:
            left[rule] = lines
        else:
            spots[spot.key].append((spot, lines))
    words = {each.name: each for each in stored.words_of(category)}
    used, changes = set(taken), []
    for some in spots.values():
        change, phrases = _change(stored, some, used)
        changes.append(change)
        if some[0][0].category.name == category or change.name in words:
            known = words.get(change.name)
            heads = frozenset((some[0][0].head,)) | (known.heads if known else frozenset())
            every = (*(known.phrases if known else ()), *phrases)
            words[change.name] = Synonyms(change.name, every, heads, holds_everywhere=False)
    written: dict[Rule, list[int]] = {}
    for rule, lines in left.items():
        written.setdefault(with_nonterminals(rule, words.values()), []).extend(lines)
    return Extension(tuple(changes), tuple(left), written)


def with_changes(category: TaskCategory, changes: Iterable[Change]) -> TaskCategory:
    """Return a task category as it is once some changes are stored."""
    sources = {each.position.source for each in category.grammar.productions}
    productions = list(category.grammar.productions)
    templates = list(category.templates)
    for edit in (edit for change in changes for edit in change.edits):
        if isinstance(edit.becomes, SemanticTemplate):
            templates = [edit.becomes if each == edit.was else each for each in templates]
        elif edit.was is not None:
            productions = [edit.becomes if each == edit.was else each for each in productions]
        elif edit.source in sources:
            productions.append(edit.becomes)
    if (*productions,) == category.grammar.productions and (*templates,) == category.templates:
        return category
    return TaskCategory(category.name, Grammar(tuple(productions)), tuple(templates))


def _best_spot(
    stored: StoredTemplates,
    rule: Rule,
    means: str,
    refused: Collection[frozenset[str]],
    budget: Budget,
) -> Spot | None:
    """Return where a command differs from a template in the fewest words; None where forms of such templates differ."""
    head = head_predicate(rule.form)
    variants = dict.fromkeys(articles_varied(rule.words))
    spots = [each for words in variants for each in stored.spots(words, head, budget)]
    found: list[tuple[Spot, str]] = []
    for spot in sorted(spots, key=lambda each: each.size):
        if found and spot.size[0] > found[0][0].size[0]:
            break
        form = stored.form_at(spot, budget) if _source_of(spot) is not None else ""
        if form and means in ("", form):
            found.append((spot, form))
    if len({form for _, form in found}) != 1 or found[0][0].refusal in refused:
        return None
    return found[0][0]


def _change(
    stored: StoredTemplates, spots: Sequence[tuple[Spot, Sequence[int]]], used: set[str]
) -> tuple[Change, tuple[Words, ...]]:
    """Return what becomes of the lines where commands say something else in one place, and all of its phrases."""
    spot = spots[0][0]
    phrases = tuple(dict.fromkeys(each.phrase for each, _ in spots))
    name, every = spot.name, phrases
    if not name and not isinstance(spot.old[0], Choice):
        old = tuple(map(print_symbol, spot.old))
        name, every = free_name(old, used), (old, *phrases)
        used.add(name)
    change = Change(
        name,
        print_sequence(spot.old),
        tuple(map(" ".join, phrases)),
        _edits(stored, spot, phrases, name),
        tuple(sorted({line for _, lines in spots for line in lines})),
        tuple(dict.fromkeys(each.comment for each, _ in spots)),
        sum(spot.old[0] in each.pattern for one in stored.categories for each in one.templates),
    )
    return change, every


def _edits(
    stored: StoredTemplates, spot: Spot, phrases: Sequence[Words], name: str
) -> tuple[Edit, ...]:
    """Return the lines that change; none where no production says what the template says."""
    more = tuple(phrase_symbols(phrase) for phrase in phrases)
    source = _source_of(spot) or ""
    if spot.name:
        was = _last_production(spot)
        assert was is not None
        becomes = replace(was, expansion=(Choice((*_alternatives(was.expansion), *more)),))
        return (Edit(was, becomes, source),)
    edits: dict[tuple[str, str], Edit] = {}
    if isinstance(spot.old[0], Choice):
        new: Choice | Nonterminal = Choice((*spot.old[0].alternatives, *more))
    else:
        new = Nonterminal(name)
        edits[source, ""] = Edit(None, Production(name, (Choice((spot.old, *more)),)), source)
    templates: list[Edit] = []
    for category, template in spot.alike(stored.categories):
        says = [each for each in _saying(category, template) if each.position.source == source]
        pattern = _exchanged(template.pattern, spot.old, new)
        for production in says:
            alternatives = tuple(
                pattern if each == template.pattern else each
                for each in _alternatives(production.expansion)
            )
            expansion = alternatives[0] if len(alternatives) == 1 else (Choice(alternatives),)
            edit = Edit(production, replace(production, expansion=expansion), source)
            edits.setdefault((source, edit.before), edit)
        if says:
            longer = make_template(print_sequence(pattern), template.form_text, template.position)
            templates.append(Edit(template, longer, template.position.source))
    edits |= {(each.source, each.before): each for each in templates}
    return tuple(edits.values())


def _source_of(spot: Spot) -> str | None:
    """Return where the production stands that changes; None where no production says what the template says."""
    says = _saying(spot.category, spot.template)
    production = _last_production(spot) if spot.name else next(says, None)
    return production.position.source if production else None


def _last_production(spot: Spot) -> Production | None:
    productions = reversed(spot.category.grammar.productions)
    return next((each for each in productions if each.nonterminal == spot.name), None)


def _saying(category: TaskCategory, template: SemanticTemplate) -> Iterator[Production]:
    """Yield the productions of which an alternative is the pattern of a template."""
    for each in category.grammar.productions:
        if template.pattern in _alternatives(each.expansion):
            yield each


def _alternatives(expansion: Symbols) -> tuple[Symbols, ...]:
    only = expansion[0] if len(expansion) == 1 else None
    return only.alternatives if isinstance(only, Choice) else (expansion,)


def _exchanged(pattern: Symbols, old: Symbols, new: Choice | Nonterminal | Text) -> Symbols:
    """Return the pattern with ``new`` for its first ``old``; as it is without one."""
    for place in range(len(pattern) - len(old) + 1):
        if pattern[place : place + len(old)] == old:
            return (*pattern[:place], new, *pattern[place + len(old) :])
    return pattern


def _line(each: Production | SemanticTemplate) -> str:
    if isinstance(each, Production):
        return print_production(each)
    return f"{each.pattern_text} = {each.form_text}"
