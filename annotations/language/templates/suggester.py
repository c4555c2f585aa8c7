"""Suggest logical forms for a pattern by analogy with the templates that are there."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, islice
from math import exp

from annotations.language.forms import (
    CONJUNCTION,
    Application,
    Form,
    Lambda,
    Nonterminal,
    Symbols,
    Unknown,
    Variable,
    canonical_text,
    canonicalize,
    predicates,
)
from annotations.language.grammar import Grammar
from annotations.language.templates.alignment import Alignment, Weights, align, weigh
from annotations.language.templates.analogy import solve
from annotations.language.templates.expansion import TaskCategory
from annotations.language.templates.form_slots import (
    Key,
    absent,
    drop_absent,
    exchange,
    fillings,
    has_absent,
    key_of,
    keys_of,
    labels_of,
    slots_of,
    with_classes,
)
from annotations.language.templates.habits import (
    Habits,
    TemplateExample,
    examples_of,
    habits_of,
    words_of,
)
from annotations.language.templates.templates import SemanticTemplate
from annotations.language.templates.units import Slot, Unit, UnitReader
from annotations.language.world import Predicate, check_form, infer_signatures

MOST_SUGGESTIONS = 9
# Only the templates nearest to the pattern are changed into a form for it.
NEAREST = 16
# What a candidate costs, in the units of a distance between patterns; measured in
# docs/design/suggestions.md. An analogy costs a share of the distance between its first and its third
# template.
ANALOGY_COST, CONTEXT_SHARE = 0.3, 0.5
# A change explains some of the distance: an exchanged predicate 1 and a share, an added slot as much as its constant.
MEND_COST, LEAST_DISTANCE = 0.6, 0.2
EXCHANGED, EXCHANGED_SHARE, ADDED = 1.0, 0.3, 0.3
LEFT_OUT_COST, UNKNOWN_COST, ODDITY_COST = 0.5, 0.5, 0.6
# A candidate counts exp(−SHARPNESS · cost); those with equal forms add up.
SHARPNESS = 2.0
# Of the slots that a form leaves out, and of the predicates that say one.
MOST_ADDED, MOST_CONSTRAINTS = 2, 2


# Of templates that were left out, the first form is right for more than nine of ten above this share
# (docs/design/suggestions.md, Filled in or offered).
SURE_SHARE = 0.75


@dataclass(frozen=True, slots=True)
class Suggestion:
    """A form for a pattern. ``template`` is the one that it was mostly made from.

    ``share`` is what part of the weight of all candidates speaks for the form. It is 0 where the pattern has a
    word that no template has: its meaning cannot be known.
    """

    form: Form
    share: float
    template: SemanticTemplate

    @property
    def is_sure(self) -> bool:
        """Whether to fill the form in, rather than to offer it."""
        return self.share > SURE_SHARE


@dataclass(frozen=True, slots=True)
class _Candidate:
    form: Form
    cost: float
    source: TemplateExample


class FormSuggester:
    """Learns from the templates of task categories.

    A form comes from a near template in one of three ways: its slots are exchanged for those of the pattern;
    then predicates and constraints are changed as the other words say; or it is changed as
    another pair of templates with the same difference of words differ (``analogy``: a : b :: near : pattern,
    where b is looked up by its counts of words).

    Args:
        predicates: those that forms may use; by default those of the templates.
    """

    def __init__(
        self,
        categories: Sequence[TaskCategory],
        predicates: Mapping[str, Predicate] | None = None,
    ) -> None:
        self.examples = examples_of(categories)
        self._declared = predicates

    def suggest(self, pattern: Symbols, grammar: Grammar) -> tuple[Suggestion, ...]:
        """Return at most ``MOST_SUGGESTIONS`` distinct forms for a pattern of ``grammar``, the best first.

        Each is well-typed and mentions no slot that the pattern lacks. Empty without templates.
        """
        target = _Target(UnitReader(grammar).units(pattern), self)
        scores: defaultdict[str, float] = defaultdict(float)
        best: dict[str, _Candidate] = {}
        for candidate in target.candidates():
            text = canonical_text(candidate.form)
            scores[text] += exp(-SHARPNESS * candidate.cost)
            if text not in best or candidate.cost < best[text].cost:
                best[text] = candidate
        ranked = sorted(scores, key=lambda text: -scores[text])
        typed = (text for text in ranked if target.is_well_typed(best[text].form))
        whole = float("inf") if target.is_new else sum(scores.values())
        return tuple(
            Suggestion(best[text].form, scores[text] / whole, best[text].source.template)
            for text in islice(typed, MOST_SUGGESTIONS)
        )

    @cached_property
    def weights(self) -> Weights:
        return weigh(example.units for example in self.examples)

    @cached_property
    def words(self) -> frozenset[str]:
        """The words and classes of the examples."""
        units = {unit for each in self.examples for unit in each.units}
        return frozenset(chain.from_iterable(map(_words, units)))

    @cached_property
    def habits(self) -> Habits:
        return habits_of(self.examples)

    @cached_property
    def predicates(self) -> Mapping[str, Predicate]:
        """The predicates that forms may use."""
        inferred = infer_signatures(
            form for each in self.examples for form in fillings(each.form, labels_of(each.units))
        )
        return self._declared or inferred

    @cached_property
    def by_bag(self) -> Mapping[frozenset[tuple[str, int]], list[TemplateExample]]:
        """The examples with the same counts of labels."""
        groups: defaultdict[frozenset[tuple[str, int]], list[TemplateExample]] = defaultdict(list)
        for example in self.examples:
            groups[frozenset(example.bag.items())].append(example)
        return groups

    def align(self, left: Sequence[Unit], right: Sequence[Unit]) -> Alignment:
        key = (tuple(left), tuple(right))
        if key not in self._alignments:
            self._alignments[key] = align(left, right, self.weights)
        return self._alignments[key]

    @cached_property
    def _alignments(self) -> dict[tuple[tuple[Unit, ...], tuple[Unit, ...]], Alignment]:
        return {}


class _Target:
    """One pattern to find forms for."""

    def __init__(self, units: tuple[Unit, ...], known: FormSuggester) -> None:
        self.units = units
        self.known = known
        self.slots, self.labels = slots_of(units), labels_of(units)
        self.bag = Counter(unit.label for unit in units)

    @property
    def is_new(self) -> bool:
        """Whether a part of the pattern shares no word or class with any example."""
        return any(_words(unit).isdisjoint(self.known.words) for unit in self.units)

    def candidates(self) -> Iterator[_Candidate]:
        """Yield forms with what they cost; a form may come several times."""
        for near in sorted(self.known.examples, key=self.distance)[:NEAREST]:
            for candidate in chain(self._transfer(near), self._by_analogy(near)):
                form = canonicalize(candidate.form)
                if not has_absent(form) and keys_of(form) <= self.slots.keys():
                    yield _Candidate(form, candidate.cost + self._penalty(form), near)

    def is_well_typed(self, form: Form) -> bool:
        known = self.known.predicates
        return not any(check_form(each, known) for each in fillings(form, self.labels))

    def distance(self, example: TemplateExample) -> float:
        return self.known.align(example.units, self.units).cost

    def _penalty(self, form: Form) -> float:
        if isinstance(form, Unknown):
            return UNKNOWN_COST
        said = keys_of(form)
        left_out = sum(key not in said and self._is_usually_said(key) for key in self.slots)
        oddity = self.known.habits.oddity(with_classes(form, self.labels))
        return LEFT_OUT_COST * left_out + ODDITY_COST * oddity

    def _is_usually_said(self, key: Key) -> bool:
        return self.labels[key].startswith("<") or key in self._tracked

    @cached_property
    def _tracked(self) -> frozenset[Key]:
        return frozenset(key for each in self.known.examples for key in keys_of(each.form))

    def _transfer(self, near: TemplateExample) -> Iterator[_Candidate]:
        alignment = self.known.align(near.units, self.units)
        form = drop_absent(exchange(near.form, self._counterparts(near)))
        if form is None:
            return
        yield _Candidate(form, alignment.cost, near)
        names, habits = self.known.predicates, self.known.habits
        yield from self._add_slots(form, alignment.cost, near)
        for exchanged in exchange_predicates(form, alignment, habits, names):
            left = alignment.cost - EXCHANGED - EXCHANGED_SHARE * alignment.cost
            yield self._mend(exchanged, left, near)
            yield from self._add_slots(exchanged, left, near)

    def _add_slots(
        self, form: Form, distance: float, near: TemplateExample
    ) -> Iterator[_Candidate]:
        slots = {key: slot for key, slot in self.slots.items() if self._is_usually_said(key)}
        for more in add_slots(form, slots, self.labels, self.known.habits):
            yield self._mend(more, distance - ADDED, near)

    def _mend(self, form: Form, distance: float, near: TemplateExample) -> _Candidate:
        """Return a form that was changed; ``distance`` is what the changes leave unexplained."""
        return _Candidate(form, max(distance, LEAST_DISTANCE) + MEND_COST, near)

    def _counterparts(self, near: TemplateExample) -> dict[Key, Slot]:
        pairs = self.known.align(near.units, self.units).slots()
        return {key_of(left): self.slots[key_of(right)] for left, right in pairs.items()}

    def _by_analogy(self, near: TemplateExample) -> Iterator[_Candidate]:
        """Yield what solves a : b :: near : target, for all a and b with the same difference of words."""
        added, removed = self.bag - near.bag, near.bag - self.bag
        if not added and not removed:
            return
        for a in self.known.examples:
            if a is near or removed - a.bag:
                continue
            bag = a.bag - removed + added
            cost = ANALOGY_COST + CONTEXT_SHARE * self.known.align(a.units, near.units).cost
            for b in self.known.by_bag.get(frozenset(bag.items()), ()):
                form = self._solve(a, b, near)
                if form is not None:
                    yield _Candidate(form, cost, near)

    def _solve(self, a: TemplateExample, b: TemplateExample, near: TemplateExample) -> Form | None:
        """Name the slots of three templates as the target does, and solve a : b :: near : target."""
        of_near = self._counterparts(near)
        a_to_near = self.known.align(a.units, near.units).slots()
        a_to_b = self.known.align(a.units, b.units).slots()
        of_a = {
            key_of(left): of_near.get(key_of(right)) or absent(right)
            for left, right in a_to_near.items()
        }
        shared = [(key_of(left), key_of(right)) for left, right in a_to_b.items()]
        of_b = {right: of_a[left] for left, right in shared if left in of_a}
        # Slots that only b has become those of the target that the near template lacks, by label in order.
        taken = {key_of(slot) for slot in of_near.values()}
        free: defaultdict[str, list[Slot]] = defaultdict(list)
        for key, slot in self.slots.items():
            if key not in taken:
                free[self.labels[key]].append(slot)
        aligned = self.known.align(b.units, self.units).slots()
        for unit in b.units:
            if unit.slot is None or key_of(unit.slot) in of_b:
                continue
            if free[unit.label]:
                of_b[key_of(unit.slot)] = free[unit.label].pop(0)
            elif unit.slot in aligned:
                of_b[key_of(unit.slot)] = self.slots[key_of(aligned[unit.slot])]
        of_a = {**{left: of_b[right] for left, right in shared if right in of_b}, **of_a}
        return solve(exchange(a.form, of_a), exchange(b.form, of_b), exchange(near.form, of_near))


def _words(unit: Unit) -> set[str]:
    return {word for phrase in unit.phrases for word in phrase.split()}


def exchange_predicates(
    form: Form, alignment: Alignment, habits: Habits, names: Iterable[str]
) -> Iterator[Form]:
    """Yield the form with a predicate that the left words say exchanged for one that the right words say."""
    names, present = tuple(names), frozenset(predicates(form))
    gone = [left for left, right in alignment.pairs if left and _is_other(left, right)]
    come = [right for left, right in alignment.pairs if right and _is_other(right, left)]
    old, new = habits.said_by(_all_words(gone), names), habits.said_by(_all_words(come), names)
    for added in sorted(new - present):
        for removed in sorted((old - new) & present):
            yield _rename(form, removed, added)


def add_slots(
    form: Form, slots: Mapping[Key, Slot], labels: Mapping[Key, str], habits: Habits
) -> Iterator[Form]:
    """Yield the form with constraints for slots that it leaves out, as other forms constrain their class."""
    missing = [key for key in slots if key not in keys_of(form)][:MOST_ADDED]
    forms = [form]
    for key in missing:
        usual = habits.constraints.get(labels[key])
        for predicate, _ in usual.most_common(MOST_CONSTRAINTS) if usual else ():
            for each in tuple(forms):
                forms.extend(_add(each, predicate, slots[key], habits))
    yield from forms[1:]


def _is_other(unit: Unit, counterpart: Unit | None) -> bool:
    return not unit.is_entity and (counterpart is None or counterpart.label != unit.label)


def _all_words(units: Iterable[Unit]) -> list[str]:
    return [word for unit in units for word in words_of(unit)]


def _rename(form: Form, old: str, new: str) -> Form:
    match form:
        case Lambda(variable, type_, bodies):
            return Lambda(variable, type_, tuple(_rename(body, old, new) for body in bodies))
        case Application(predicate, arguments):
            name = new if predicate == old else predicate
            return Application(name, tuple(_rename(each, old, new) for each in arguments))
        case _:
            return form


def _add(form: Form, predicate: str | Nonterminal, slot: Slot, habits: Habits) -> Iterator[Form]:
    """Yield the form with ``(predicate $v slot)`` added to each of its conjunctions in turn."""
    match form:
        case Lambda(variable, type_, (Application(predicate, conjuncts),)) if (
            predicate == CONJUNCTION
        ):
            added = Application(predicate, (Variable(variable), slot))
            whole = Application(CONJUNCTION, habits.place(conjuncts, added))
            yield Lambda(variable, type_, (whole,))
        case Lambda(variable, type_, bodies):
            if not any(isinstance(body, Lambda) for body in bodies):
                added = Application(predicate, (Variable(variable), slot))
                yield Lambda(variable, type_, habits.place(bodies, added))
            for each in _add_inside(bodies, predicate, slot, habits):
                yield Lambda(variable, type_, each)
        case Application(name, arguments):
            for each in _add_inside(arguments, predicate, slot, habits):
                yield Application(name, each)


def _add_inside(
    parts: tuple[Form, ...], predicate: str | Nonterminal, slot: Slot, habits: Habits
) -> Iterator[tuple[Form, ...]]:
    for place, part in enumerate(parts):
        for changed in _add(part, predicate, slot, habits):
            yield (*parts[:place], changed, *parts[place + 1 :])
