"""Sample the commands of a large language: so many of them as one asks for, without making all.

The derivations of all templates have numbers (``ranked_templates``). A seed shuffles the numbers, and each is read
as a command until there are enough, so that a sample is exact, has no command twice, is the beginning of
a larger sample with the same seed, and is the same on every machine. A command that several
derivations make is taken once, with the form that ``generate`` would give it: a chart of all templates says
which that is.
"""

from __future__ import annotations

from bisect import bisect_right
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import accumulate
from random import Random

from annotations.language.grammar import (
    Expander,
    Recognizer,
    RuleBook,
    WordChart,
    anonymized,
    readable,
    recognizer_of,
)
from annotations.language.templates.chart import ChartDerivation, TemplateChart
from annotations.language.templates.composition import SynchronousGrammar
from annotations.language.templates.expansion import (
    Conflict,
    Expansion,
    Generated,
    LeftOut,
    TaskCategory,
)
from annotations.language.templates.ranked_templates import (
    FormClass,
    LineCounts,
    RankedDerivation,
    RankedGrammar,
    RankedTemplate,
)
from annotations.language.templates.sample_notes import Balance, SampleNote, SampleRequest
from annotations.language.texts import LanguageError, Problem

# A sample that asks for every form looks at all of them first: about 10,000 a second.
MOST_FORMS = 100_000
# So many derivations are looked at for each command that is asked for. Where a language says each of its commands
# in more ways than that, a sample can end before it has as many commands as it should have.
MOST_DRAWS_PER_COMMAND = 50
FEWEST_DRAWS = 100_000
# After so many derivations in a row that say nothing new, a line (or a form) with more of them has given what it has.
MOST_IN_VAIN = 1_000
# After so many in a row, its lines are no longer chosen evenly.
MOST_UNEVEN = 50


@dataclass(frozen=True)
class Sample:
    """What ``sample`` gives.

    ``generated`` is as ``generate`` would have it, of the commands of the sample alone; it says of no template
    that it is unmatched. ``note`` says how many there are.
    """

    generated: Generated
    note: SampleNote


@dataclass(frozen=True, slots=True)
class _Population:
    """The derivations of one template of one task category."""

    category: TaskCategory
    template_index: int
    ranked: RankedTemplate

    @property
    def key(self) -> tuple[str, str, str]:
        template = self.ranked.template
        return self.category.name, template.pattern_text, template.form_text


@dataclass(frozen=True, slots=True)
class _Drawn:
    """A derivation with its command. ``form_text`` is the form that it gives, which another may win."""

    population: _Population
    derivation: RankedDerivation
    command: str
    form_text: str


class _CannotBeStored(Exception):
    """A drawn derivation shows that a template has to be left out."""

    def __init__(self, population: _Population, problem: Problem) -> None:
        super().__init__(problem.message)
        self.population = population
        self.problem = problem


class Language:
    """The commands that the templates of task categories make, counted and not enumerated.

    Raises:
        LanguageError: a grammar, or the lines of a task category, have a cycle.
    """

    def __init__(self, categories: Sequence[TaskCategory]) -> None:
        self.categories = tuple(categories)
        self.left_out: list[LeftOut] = []
        self._populations: list[_Population] = []
        for category in categories:
            grammar = RankedGrammar(category.grammar, category.lines)
            for index, template in enumerate(category.templates):
                if template.nonterminal:
                    continue
                try:
                    ranked = grammar.template(template)
                except LanguageError as error:
                    self.left_out.append(LeftOut(category.name, index, error.problem))
                    continue
                if ranked.size:
                    self._populations.append(_Population(category, index, ranked))
        self._populations.sort(key=lambda each: each.key)

    @property
    def size(self) -> int:
        """The number of derivations, an upper bound on the number of distinct commands.

        It is exact for each template: combinations that disagree about a nonterminal are not counted.
        """
        return sum(each.ranked.size for each in self._populations)

    def sample(
        self, request: SampleRequest, report: Callable[[float], None] = lambda share: None
    ) -> Sample:
        """Draw commands without repetition, each with the form that ``generate`` gives it.

        A template of which a drawn command cannot be stored is left out, and the sample is drawn anew.

        Args:
            report: is told which share of the commands is there.

        Raises:
            LanguageError: nothing or less than nothing is asked for; or all forms are, and there are more
                than ``MOST_FORMS``.
        """
        if request.size < 1:
            raise LanguageError("a sample has at least one command", hint="ask for more")
        while True:
            try:
                return _Drawing(self, self._populations, request, report).sample()
            except _CannotBeStored as found:
                self._populations.remove(found.population)
                place = found.population.category.name, found.population.template_index
                self.left_out.append(LeftOut(*place, found.problem))


@dataclass(frozen=True, slots=True)
class _Judged:
    """A command with everything that templates say of it."""

    expansion: Expansion
    conflicts: tuple[Conflict, ...]


class _Judge:
    """Says which form ``generate`` would give a command."""

    def __init__(
        self, categories: Sequence[TaskCategory], populations: Sequence[_Population]
    ) -> None:
        used = {(each.category.name, each.template_index) for each in populations}
        self._places: dict[str, list[int]] = {}  # index among the templates used → among all
        self._recognizers: dict[str, Recognizer] = {}
        with_templates = []
        for category in categories:
            places = [
                index
                for index, template in enumerate(category.templates)
                if template.nonterminal or (category.name, index) in used
            ]
            self._places[category.name] = places
            templates = tuple(category.templates[index] for index in places)
            with_templates.append(TaskCategory(category.name, category.grammar, templates))
            self._recognizers[category.name] = recognizer_of(category.grammar)
        self._charts = {each.name: TemplateChart([each]) for each in with_templates}
        self._rules = {each.name: _WordRules(each) for each in with_templates}
        self._inside = {  # the templates all of whose commands the grammar derives
            (category.name, index)
            for category in categories
            for index in self._places[category.name]
            if self._rules[category.name].grammar.is_inside(category.templates[index])
        }

    def judge(self, drawn: _Drawn) -> _Judged:
        """Return what becomes of the command of a derivation."""
        derivations: list[ChartDerivation] = []
        for name in self._charts:
            derivations += self._derivations(drawn, name, is_first=not derivations)
        kept = derivations[0]
        place = kept.task_category, kept.template_index
        in_grammar = place in self._inside or self._recognizers[kept.task_category].accepts(
            drawn.command
        )
        expansion = Expansion(
            drawn.command, kept.form_text, kept.task_category, kept.template_index, in_grammar
        )
        by_category: dict[str, dict[str, int]] = {}
        for each in derivations:  # the one that wins is first
            by_category.setdefault(each.task_category, {}).setdefault(
                each.form_text, each.template_index
            )
        conflicts = (
            Conflict(
                category,
                drawn.command,
                tuple((index, form) for form, index in reversed(forms.items())),
            )
            for category, forms in by_category.items()
            if len(forms) > 1
        )
        return _Judged(expansion, tuple(conflicts))

    def _derivations(
        self, drawn: _Drawn, category: str, is_first: bool
    ) -> Iterable[ChartDerivation]:
        """Yield the derivations of the command in a category, by a chart only where there may be another than the
        drawn one; none where there is one at most and another category ``is_first``, which wins."""
        count = self._rules[category].count(tuple(drawn.command.split()), at_most=2)
        if not count or (count == 1 and not is_first):
            return
        if count == 1 and category == drawn.population.category.name:
            yield ChartDerivation(drawn.form_text, category, drawn.population.template_index)
            return
        for each in self._charts[category].parse(drawn.command):
            place = self._places[category][each.template_index]
            yield ChartDerivation(each.form_text, category, place)


class _WordRules:
    """Counts the ways in which templates and their lines derive words, whatever their nonterminals became.

    So it never counts too few, and is much quicker than a parse that gives forms.
    """

    def __init__(self, category: TaskCategory) -> None:
        self.grammar = SynchronousGrammar(category.grammar, category.lines)
        lines = {
            name: [line.pattern for line in lines] for name, lines in self.grammar.lines_of.items()
        }
        self._book = RuleBook(Expander(self.grammar.alternatives, anonymized), lines)
        self._roots = [
            self._book.add_pattern(each.pattern)
            for each in category.templates
            if not each.nonterminal
        ]

    def count(self, words: tuple[str, ...], at_most: int) -> int:
        """Return how many derivations ``words`` have, or ``at_most`` where they have more."""
        chart = WordChart(self._book, words, at_most)
        found = 0
        for root in self._roots:
            found += chart.ways(root)
            if found >= at_most:
                return at_most
        return found


class _Drawing:
    """One attempt at a sample."""

    def __init__(
        self,
        language: Language,
        populations: Sequence[_Population],
        request: SampleRequest,
        report: Callable[[float], None],
    ) -> None:
        self._language = language
        self._populations = populations
        self._request = request
        self._report = report
        self._judge = _Judge(language.categories, populations)
        self._judged: dict[str, _Judged] = {}  # every command that was looked at
        self._taken: dict[str, None] = {}
        self._n_drawn = 0
        self._is_cut = False  # there may be commands that were not looked at
        self._most_drawn = max(request.size * MOST_DRAWS_PER_COMMAND, FEWEST_DRAWS)

    def sample(self) -> Sample:
        match self._request.balance:
            case Balance.NONE:
                self._take_any()
            case Balance.LINES:
                self._take_in_turn(self._lines())
            case Balance.FORMS:
                self._take_in_turn(self._forms())
        order = {each.name: place for place, each in enumerate(self._language.categories)}
        judged = [self._judged[command] for command in self._taken]
        judged.sort(
            key=lambda each: (order[each.expansion.task_category], each.expansion.template_index)
        )
        generated = Generated(
            tuple(each.expansion for each in judged),
            tuple(conflict for each in judged for conflict in each.conflicts),
            (),
            tuple(self._language.left_out),
        )
        note = SampleNote(self._request, len(judged), self._language.size, is_all=not self._is_cut)
        return Sample(generated, note)

    def _is_full(self) -> bool:
        is_full = len(self._taken) >= self._request.size or self._n_drawn >= self._most_drawn
        self._is_cut |= is_full
        return is_full

    def _take(self, drawn: _Drawn) -> None:
        self._taken[drawn.command] = None
        self._report(len(self._taken) / self._request.size)

    def _take_any(self) -> None:
        for drawn in self._shuffle(self._populations, Random(self._request.seed)):
            if drawn.command not in self._taken:
                self._look_up(drawn)
                self._take(drawn)
            if self._is_full():
                return

    def _take_in_turn(self, groups: Mapping[str, _Group]) -> None:
        """Take a command from each group, and another from each, as long as they have any."""
        waiting = [groups[name] for name in sorted(groups)]
        Random(self._request.seed).shuffle(waiting)
        while waiting:
            still = []
            for group in waiting:
                if self._is_full():
                    return
                if (drawn := self._next_of(group)) is not None:
                    self._take(drawn)
                    still.append(group)
            waiting = still

    def _next_of(self, group: _Group) -> _Drawn | None:
        """Return the next derivation of a group that gives a new command its form; None where there is none."""
        for in_vain, drawn in enumerate(group.derivations, start=1):
            if drawn.command not in self._taken and group.is_of(self._look_up(drawn).expansion):
                return drawn
            is_given_up = in_vain >= MOST_IN_VAIN and group.size > FEWEST_DRAWS
            if is_given_up or self._n_drawn >= self._most_drawn:
                self._is_cut = True
                return None
        return None

    def _lines(self) -> dict[str, _Group]:
        by_line: dict[str, list[_Population]] = {}
        for each in self._populations:
            by_line.setdefault("\n".join(each.key[1:]), []).append(each)
        used: LineCounts = Counter()
        groups = {}
        for line, populations in by_line.items():
            places = {(each.category.name, each.template_index) for each in populations}
            groups[line] = _Group(
                sum(each.ranked.size for each in populations),
                lambda expansion, places=places: (  # type: ignore[misc]
                    (expansion.task_category, expansion.template_index) in places
                ),
                self._line_by_line(populations, self._random_of(line), used),
            )
        return groups

    def _line_by_line(
        self, populations: Sequence[_Population], random: Random, used: LineCounts
    ) -> Iterator[_Drawn]:
        """Yield derivations of one line of the templates, at first with all lines below it equally often."""
        seen: set[RankedDerivation] = set()
        repeated = 0
        with_lines = [each for each in populations if each.ranked.has_lines]
        while with_lines and repeated < MOST_UNEVEN:
            population = random.choice(with_lines)
            derivation = population.ranked.derivation_by_lines(random, used)
            repeated = repeated + 1 if derivation in seen else 0
            if not repeated:
                seen.add(derivation)
                yield from self._read(population, derivation)
        yield from self._shuffle(populations, random)

    def _forms(self) -> dict[str, _Group]:
        n_forms = sum(each.ranked.n_forms for each in self._populations)
        if n_forms > MOST_FORMS:
            raise LanguageError(
                f"the language has up to {readable(n_forms)} logical forms, and a sample can have equally many "
                f"commands of each of at most {MOST_FORMS:,}",
                hint="balance the lines of the templates",
            )
        classes: dict[str, list[tuple[_Population, FormClass]]] = {}
        for population in self._populations:
            for form in population.ranked.form_classes():
                first = population.ranked.derivation_of(form, 0)
                for drawn in self._read(population, first):
                    classes.setdefault(drawn.form_text, []).append((population, form))
        self._n_drawn = 0  # nothing was drawn so far
        return {
            text: _Group(
                sum(form.size for _, form in of_form),
                lambda expansion, text=text: expansion.form_text == text,  # type: ignore[misc]
                self._shuffle_forms(of_form, self._random_of(text)),
            )
            for text, of_form in classes.items()
        }

    def _shuffle(self, populations: Sequence[_Population], random: Random) -> Iterator[_Drawn]:
        ends = list(accumulate(each.ranked.size for each in populations))
        for rank in shuffled(ends[-1] if ends else 0, random):
            place = bisect_right(ends, rank)
            population = populations[place]
            before = ends[place - 1] if place else 0
            yield from self._read(population, population.ranked.derivation(rank - before))

    def _shuffle_forms(
        self, of_form: Sequence[tuple[_Population, FormClass]], random: Random
    ) -> Iterator[_Drawn]:
        ends = list(accumulate(form.size for _, form in of_form))
        for rank in shuffled(ends[-1], random):
            place = bisect_right(ends, rank)
            population, form = of_form[place]
            before = ends[place - 1] if place else 0
            yield from self._read(population, population.ranked.derivation_of(form, rank - before))

    def _random_of(self, text: str) -> Random:
        """Return the random numbers of one line or form, which do not depend on other lines and forms."""
        return Random(f"{self._request.seed} {text}")

    def _read(self, population: _Population, derivation: RankedDerivation) -> Iterator[_Drawn]:
        """Yield the derivation with its command, or nothing where it has no words."""
        self._n_drawn += 1
        try:
            words, form_text = population.ranked.pair(derivation)
        except LanguageError as error:
            raise _CannotBeStored(population, error.problem) from None
        if words:
            yield _Drawn(population, derivation, " ".join(words), form_text)

    def _look_up(self, drawn: _Drawn) -> _Judged:
        if drawn.command not in self._judged:
            self._judged[drawn.command] = self._judge.judge(drawn)
        return self._judged[drawn.command]


@dataclass(frozen=True, slots=True)
class _Group:
    """Derivations that have a line, or a form, in common. ``is_of`` says whether a command has it in the end."""

    size: int
    is_of: Callable[[Expansion], bool]
    derivations: Iterator[_Drawn]


def shuffled(size: int, random: Random) -> Iterator[int]:
    """Yield the numbers from 0 to ``size`` - 1, each once, in an order that ``random`` chooses.

    This is the shuffle of Fisher and Yates. Only what has been moved is kept: memory grows with the
    numbers that are asked for, whatever the size.
    """
    moved: dict[int, int] = {}
    place = 0
    while place < size:
        other = random.randrange(place, size)
        here = moved.pop(place, place)
        if other == place:
            yield here
        else:
            yield moved.get(other, other)
            moved[other] = here
        place += 1
