"""Number the derivations of templates: count them without enumeration, and go from a number to a command and form.

Nonterminals that a form mentions become the same wherever they stand, so each of them is expanded once: the
pattern is counted with them as they are, apart for each set of them that a derivation has
(``annotations.language.grammar.ranking``). Then what each becomes is counted, those above before those below. A
nonterminal with lines becomes a derivation of one of its lines. So no number stands for a derivation that
synchronous expansion would discard.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache
from itertools import chain
from random import Random
from typing import TypeAlias

from annotations.language.forms import Choice, Symbols, canonical_text
from annotations.language.grammar import (
    CHECK_STEPS,
    Atoms,
    Budget,
    Choices,
    Cursor,
    Grammar,
    Production,
    RankedRule,
    RankedSequence,
    Ranking,
)
from annotations.language.templates.composition import SynchronousGrammar, names_in_order
from annotations.language.templates.filling import Composed, fill_anonymized, precedence_of
from annotations.language.templates.synchronous import Derivation, TemplateExpander
from annotations.language.templates.templates import SemanticTemplate
from annotations.language.texts import MAX_INDEXED_BYTES, LanguageError

# (nonterminal, number of the line): how often a sample has it.
LineCounts: TypeAlias = "Counter[tuple[str, int]]"


@dataclass(frozen=True, slots=True)
class RankedDerivation:
    """One derivation of a template or a line: the choices of its pattern, and what the nonterminals of its form became.

    A nonterminal became choices, or a derivation of a line.
    """

    choices: Choices
    became: tuple[tuple[str, Became], ...]


@dataclass(frozen=True, slots=True)
class LineDerivation:
    """A derivation of one of the lines of a nonterminal; ``number`` is that of the line among these."""

    number: int
    derivation: RankedDerivation


Became: TypeAlias = "Choices | LineDerivation"


@dataclass(frozen=True, slots=True)
class FormClass:
    """The derivations of a template that have one form, since all that the form mentions is the same.

    ``atoms`` are the nonterminals of the form that stand in the pattern. ``became`` has the choices of
    nonterminals without lines; ``lines`` the number and the class of a line for each of the others.
    """

    atoms: Atoms
    became: tuple[tuple[str, Choices], ...]
    lines: tuple[tuple[str, int, FormClass], ...]
    size: int


class RankedGrammar:
    """The numbered templates and lines of one task category.

    Raises:
        LanguageError: the grammar, or the lines, have a cycle.
    """

    def __init__(self, grammar: Grammar, lines: tuple[SemanticTemplate, ...] = ()) -> None:
        self.expander = TemplateExpander(grammar, lines)
        self.rules = SynchronousGrammar(grammar, lines)
        self.budget = Budget(CHECK_STEPS)
        self._rankings: dict[frozenset[str], Ranking] = {}
        self._lines: dict[str, tuple[RankedTemplate, ...]] = {}

    def template(self, template: SemanticTemplate) -> RankedTemplate:
        """Return a template with its derivations numbered.

        Raises:
            LanguageError: one of its commands could have more than ``MAX_WORDS`` words.
            TooManyCombinations: its form mentions so many nonterminals that counting takes too long.
        """
        self.expander.size(template)
        return RankedTemplate(self, template)

    def ranking(self, tracked: frozenset[str]) -> Ranking:
        """Return the numbered rules in which the ``tracked`` nonterminals are atoms."""
        if tracked not in self._rankings:
            atoms = self._downwards(tracked)
            self._rankings[tracked] = Ranking(self.rules.alternatives, atoms, self.budget)
        return self._rankings[tracked]

    def lines(self, name: str) -> tuple[RankedTemplate, ...]:
        """Return the lines of ``$name``; none where it has none."""
        if name not in self._lines:
            lines = self.rules.lines_of.get(name, ())
            self._lines[name] = tuple(RankedTemplate(self, line) for line in lines)
        return self._lines[name]

    def _downwards(self, names: Iterable[str]) -> tuple[str, ...]:
        """Return each nonterminal before those that it can reach, others by name."""
        waiting = sorted(names)
        below = {name: self.rules.words.reachable(name) - {name} for name in waiting}
        ordered: list[str] = []
        while waiting:
            free = next(
                name for name in waiting if not any(name in below[each] for each in waiting)
            )
            waiting.remove(free)
            ordered.append(free)
        return tuple(ordered)


class RankedTemplate:
    """The derivations of a template or a line, numbered from 0 to ``size`` - 1."""

    def __init__(self, grammar: RankedGrammar, template: SemanticTemplate) -> None:
        self.template = template
        self._grammar = grammar
        self._ranking = grammar.ranking(template.tracked)
        self._names = names_in_order(template)
        self._composed = frozenset(grammar.rules.composed(template))
        self._all: Atoms = sum(map(self._ranking.bit, self._names))
        self._sequence = self._ranking.sequence(template.pattern)
        self._completions = cache(self._count_completions)
        self._forms_from = cache(self._count_forms)
        patterns = self._sequence.counts.items()
        self._counts = {atoms: count * self._completions(0, atoms) for atoms, count in patterns}
        self.size = sum(self._counts.values())

    @property
    def has_lines(self) -> bool:
        """Whether the form mentions a nonterminal that has lines."""
        return bool(self._composed)

    @property
    def n_forms(self) -> int:
        """An upper bound on the number of distinct forms."""
        return sum(self._forms_from(0, atoms) for atoms in self._counts)

    def derivation(self, rank: int) -> RankedDerivation:
        """Return derivation ``rank``. Raises IndexError if there are not so many."""
        atoms, rank = _pick(self._counts, rank)
        rank, of_pattern = divmod(rank, self._sequence.counts[atoms])
        choices = self._sequence.choices(atoms, of_pattern)
        became: list[tuple[str, Became]] = []
        for place, name in enumerate(self._ranking.atoms):
            if not atoms & self._ranking.bit(name):
                continue
            if name in self._composed:
                own, rank = divmod(rank, self._completions(place + 1, atoms))
                became.append((name, self._line_derivation(name, own)))
            else:
                body = self._ranking.body(name)
                inner, rank = _pick(self._weights(place, atoms, body), rank)
                own, rank = divmod(rank, self._completions(place + 1, atoms | inner))
                became.append((name, body.choices(inner, own)))
                atoms |= inner
        return RankedDerivation(choices, tuple(became))

    def derivation_by_lines(self, random: Random, used: LineCounts) -> RankedDerivation:
        """Draw a derivation in which nonterminals take their least ``used`` lines, and count these."""
        atoms = _draw(self._counts, random)
        choices = self._sequence.choices(atoms, random.randrange(self._sequence.counts[atoms]))
        became: list[tuple[str, Became]] = []
        for place, name in enumerate(self._ranking.atoms):
            if not atoms & self._ranking.bit(name):
                continue
            if name in self._composed:
                lines = self._grammar.lines(name)
                numbers = [number for number, line in enumerate(lines) if line.size]
                number = min(numbers, key=lambda each: (used[name, each], random.random()))
                used[name, number] += 1
                inner_line = lines[number].derivation_by_lines(random, used)
                became.append((name, LineDerivation(number, inner_line)))
            else:
                body = self._ranking.body(name)
                inner = _draw(self._weights(place, atoms, body), random)
                became.append((name, body.choices(inner, random.randrange(body.counts[inner]))))
                atoms |= inner
        return RankedDerivation(choices, tuple(became))

    def form_classes(self) -> Iterator[FormClass]:
        """Yield the classes of derivations with one form; two classes may have the same form."""
        for atoms, count in self._sequence.counts.items():
            for became, lines in self._assignments(0, atoms):
                size = count
                for _, _, line in lines:
                    size *= line.size
                yield FormClass(atoms, became, lines, size)

    def derivation_of(self, form: FormClass, rank: int) -> RankedDerivation:
        """Return derivation ``rank`` of those of a class; 0 ≤ rank < form.size."""
        rank, of_pattern = divmod(rank, self._sequence.counts[form.atoms])
        became: dict[str, Became] = dict(form.became)
        for name, number, inner in form.lines:
            rank, own = divmod(rank, inner.size)
            line = self._grammar.lines(name)[number]
            became[name] = LineDerivation(number, line.derivation_of(inner, own))
        choices = self._sequence.choices(form.atoms, of_pattern)
        return RankedDerivation(choices, tuple(became.items()))

    def pair(self, derivation: RankedDerivation) -> tuple[tuple[str, ...], str]:
        """Return the words of a derivation and the canonical text of its form.

        Raises:
            LanguageError: a text is too long to be stored, or the words for a predicate are not a name.
        """
        words, filled = self._read(derivation)
        text = canonical_text(filled.form)
        self._require_indexable(" ".join(words), "command")
        self._require_indexable(text, "form")
        return words, text

    def derivations_of(self, words: tuple[str, ...], form_text: str) -> Iterator[RankedDerivation]:
        """Yield the derivations that become ``words`` with a form.

        Raises:
            TooManyCombinations: while looking, when that takes more than ``CHECK_STEPS``.
        """
        for derivation in _Matcher(self, words, Budget(CHECK_STEPS), {}).derivations(0, len(words)):
            if self.pair(derivation)[1] == form_text:
                yield derivation

    def intact(self, derivation: RankedDerivation, index: int) -> list[Derivation]:
        """Return the derivations that become the same words, with their wildcards, as ``TemplateExpander`` makes them.

        Args:
            index: the template's number in its set, copied into each derivation.
        """
        words, _ = self._read(derivation)
        productions: list[Production] = []
        lines: list[SemanticTemplate] = []
        template = self._narrow(derivation, productions, lines)
        expander = TemplateExpander(Grammar(tuple(productions)), tuple(lines))
        text = " ".join(words)
        return [
            each for each in expander.derivations(template, index) if each.anonymized_text == text
        ]

    def _narrow(
        self,
        derivation: RankedDerivation,
        productions: list[Production],
        lines: list[SemanticTemplate],
    ) -> SemanticTemplate:
        """Return the template with nothing but one derivation, and collect what its nonterminals become."""
        for name, value in derivation.became:
            if isinstance(value, LineDerivation):
                line = self._grammar.lines(name)[value.number]
                lines.append(line._narrow(value.derivation, productions, lines))
            else:
                expansion = self._ranking.narrow_body(name, Cursor(value))
                symbols: Symbols = (Choice(expansion),)
                productions.append(Production(name, symbols, self.template.position))
        pattern = self._ranking.narrow(self.template.pattern, Cursor(derivation.choices))
        return replace(self.template, pattern=pattern)

    def _read(self, derivation: RankedDerivation) -> tuple[tuple[str, ...], Composed]:
        values = dict(derivation.became)
        words_of: dict[str, tuple[str, ...]] = {}
        bound: dict[str, tuple[str, ...] | Composed] = {}

        def spell(pieces: Iterable[tuple[str, ...] | str]) -> tuple[str, ...]:
            return tuple(
                chain.from_iterable(
                    words_of[piece] if isinstance(piece, str) else piece for piece in pieces
                )
            )

        for name in reversed(self._ranking.atoms):  # from below, so that what is inside is known
            if name not in values:
                continue
            value = values[name]
            if isinstance(value, LineDerivation):
                line = self._grammar.lines(name)[value.number]
                words, filled = line._read(value.derivation)
                words_of[name] = words
                bound[name] = Composed(filled.form, (value.number, *filled.precedence))
            else:
                words_of[name] = spell(self._ranking.body(name).spell(Cursor(value)))
                bound[name] = words_of[name]
        words = spell(self._sequence.spell(Cursor(derivation.choices)))
        try:
            form = fill_anonymized(self.template.form, bound)
        except LanguageError as error:
            raise LanguageError(error.message, self.template.form_position, error.hint) from None
        return words, Composed(form, tuple(map(precedence_of, map(bound.__getitem__, self._names))))

    def _line_derivation(self, name: str, rank: int) -> LineDerivation:
        lines = self._grammar.lines(name)
        number, rank = _pick({number: line.size for number, line in enumerate(lines)}, rank)
        return LineDerivation(number, lines[number].derivation(rank))

    def _weights(self, place: int, atoms: Atoms, body: RankedRule) -> dict[Atoms, int]:
        """Return how many ways of completing begin with each set of atoms inside the one at ``place``."""
        return {
            inner: count * self._completions(place + 1, atoms | inner)
            for inner, count in body.counts.items()
        }

    def _count_completions(self, place: int, atoms: Atoms) -> int:
        """Count what ``atoms``, from the one at ``place`` on, may become, so that the form has all it mentions."""
        if place == len(self._ranking.atoms):
            return int(atoms == self._all)
        name = self._ranking.atoms[place]
        if not atoms & self._ranking.bit(name):
            return self._completions(place + 1, atoms)
        if name in self._composed:
            size = sum(line.size for line in self._grammar.lines(name))
            return size * self._completions(place + 1, atoms)
        return sum(self._weights(place, atoms, self._ranking.body(name)).values())

    def _count_forms(self, place: int, atoms: Atoms) -> int:
        if place == len(self._ranking.atoms):
            return int(atoms == self._all)
        name = self._ranking.atoms[place]
        if not atoms & self._ranking.bit(name):
            return self._forms_from(place + 1, atoms)
        if name in self._composed:
            n_forms = sum(line.n_forms for line in self._grammar.lines(name))
            return n_forms * self._forms_from(place + 1, atoms)
        return sum(
            count * self._forms_from(place + 1, atoms | inner)
            for inner, count in self._ranking.body(name).counts.items()
        )

    def _assignments(
        self, place: int, atoms: Atoms
    ) -> Iterator[tuple[tuple[tuple[str, Choices], ...], tuple[tuple[str, int, FormClass], ...]]]:
        """Yield what ``atoms``, from the one at ``place`` on, may become, so that the form has all it mentions."""
        if not self._completions(place, atoms):
            return
        if place == len(self._ranking.atoms):
            yield (), ()
            return
        name = self._ranking.atoms[place]
        if not atoms & self._ranking.bit(name):
            yield from self._assignments(place + 1, atoms)
        elif name in self._composed:
            for became, lines in self._assignments(place + 1, atoms):
                for number, line in enumerate(self._grammar.lines(name)):
                    for form in line.form_classes():
                        yield became, ((name, number, form), *lines)
        else:
            body = self._ranking.body(name)
            for inner, count in body.counts.items():
                for became, lines in self._assignments(place + 1, atoms | inner):
                    for rank in range(count):
                        yield ((name, body.choices(inner, rank)), *became), lines

    def _require_indexable(self, text: str, what: str) -> None:
        size = len(text.encode())
        if size > MAX_INDEXED_BYTES:
            raise LanguageError(
                f"a {what} of the template has {size:,} bytes",
                self.template.position,
                f"{MAX_INDEXED_BYTES:,} is the limit; shorten the pattern and the form",
            )


# Nonterminals that the form mentions → where they stand.
_Spans: TypeAlias = "dict[str, tuple[int, int]]"


class _Matcher:
    """Finds the derivations of one template or line between places of a command."""

    def __init__(
        self,
        ranked: RankedTemplate,
        words: tuple[str, ...],
        budget: Budget,
        others: dict[RankedTemplate, _Matcher],
    ) -> None:
        self._ranked = ranked
        self._words = words
        self._budget = budget
        self._others = others  # one for each line, so that each place is looked at once
        self._ends: dict[tuple[RankedRule, int], frozenset[int]] = {}
        others[ranked] = self

    def derivations(self, start: int, end: int) -> Iterator[RankedDerivation]:
        """Yield the derivations between two places."""
        for choices, spans in self._of_sequence(self._ranked._sequence, 0, start, end, {}):
            for became in self._became(0, spans):
                yield RankedDerivation(choices, became)

    def ends(self, start: int) -> frozenset[int]:
        """Return where a derivation that begins at ``start`` can end."""
        return self._ends_of_sequence(self._ranked._sequence, start)

    def _became(self, place: int, spans: _Spans) -> Iterator[tuple[tuple[str, Became], ...]]:
        """Yield what the atoms became, from the one at ``place`` on."""
        ranking = self._ranked._ranking
        if place == len(ranking.atoms):
            if len(spans) == len(ranking.atoms):
                yield ()
            return
        name = ranking.atoms[place]
        if name not in spans:
            yield from self._became(place + 1, spans)
        elif name in self._ranked._composed:
            for number, line in enumerate(self._ranked._grammar.lines(name)):
                for inner in self._of_line(line).derivations(*spans[name]):
                    for others in self._became(place + 1, spans):
                        yield (name, LineDerivation(number, inner)), *others
        else:
            for choices, below in self._of_rule(ranking.body(name), *spans[name], spans):
                for others in self._became(place + 1, below):
                    yield (name, choices), *others

    def _of_line(self, line: RankedTemplate) -> _Matcher:
        return self._others.get(line) or _Matcher(line, self._words, self._budget, self._others)

    def _of_rule(
        self, rule: RankedRule, start: int, end: int, spans: _Spans
    ) -> Iterator[tuple[Choices, _Spans]]:
        if rule.atom:
            before = spans.setdefault(rule.name, (start, end))
            if self._words[slice(*before)] == self._words[start:end]:
                yield (), spans
            return
        for number, sequence in enumerate(rule.sequences):
            if end in self._ends_of_sequence(sequence, start):
                for choices, bound in self._of_sequence(sequence, 0, start, end, spans):
                    yield (number, *choices), bound

    def _of_sequence(
        self, sequence: RankedSequence, index: int, start: int, end: int, spans: _Spans
    ) -> Iterator[tuple[Choices, _Spans]]:
        self._budget.spend()
        if index == len(sequence.parts):
            if start == end:
                yield (), spans
            return
        part = sequence.parts[index]
        if isinstance(part, tuple):
            stop = start + len(part)
            if self._words[start:stop] == part:
                yield from self._of_sequence(sequence, index + 1, stop, end, spans)
            return
        for stop in sorted(self._ends_of(part, start)):
            if stop <= end:
                for choices, bound in self._of_rule(part, start, stop, dict(spans)):
                    following = self._of_sequence(sequence, index + 1, stop, end, bound)
                    for others, all_bound in following:
                        yield (*choices, *others), all_bound

    def _ends_of(self, rule: RankedRule, start: int) -> frozenset[int]:
        key = rule, start
        if key not in self._ends:
            if rule.name in self._ranked._composed and rule.atom:
                lines = self._ranked._grammar.lines(rule.name)
                ends = [self._of_line(line).ends(start) for line in lines]
            else:
                body = self._ranked._ranking.body(rule.name) if rule.atom else rule
                ends = [self._ends_of_sequence(each, start) for each in body.sequences]
            self._ends[key] = frozenset().union(*ends)
        return self._ends[key]

    def _ends_of_sequence(self, sequence: RankedSequence, start: int) -> frozenset[int]:
        reached = frozenset((start,))
        for part in sequence.parts:
            self._budget.spend(len(reached))
            if isinstance(part, tuple):
                reached = frozenset(
                    place + len(part)
                    for place in reached
                    if self._words[place : place + len(part)] == part
                )
            else:
                reached = frozenset().union(*(self._ends_of(part, place) for place in reached))
            if not reached:
                break
        return reached


def _pick(counts: Mapping[int, int], rank: int) -> tuple[int, int]:
    """Return the key in whose share of all numbers ``rank`` is, and the rank there."""
    for key, count in counts.items():
        if rank < count:
            return key, rank
        rank -= count
    raise IndexError("there are not so many derivations")


def _draw(counts: Mapping[int, int], random: Random) -> int:
    """Draw a key as often as its count says."""
    return _pick(counts, random.randrange(sum(counts.values())))[0]
