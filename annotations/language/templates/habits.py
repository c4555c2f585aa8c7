"""What the forms of a world usually look like, and which words go with which predicate."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

from annotations.language.forms import (
    Application,
    ConjunctOrder,
    Form,
    Lambda,
    Nonterminal,
    Variable,
    Wildcard,
    canonical_text,
    canonicalize,
    conjunctions,
    head_of,
    order_of,
    predicates,
    walk,
)
from annotations.language.templates.expansion import TaskCategory
from annotations.language.templates.form_slots import key_of, labels_of, with_classes
from annotations.language.templates.templates import SemanticTemplate
from annotations.language.templates.units import Unit, UnitReader
from annotations.language.world import signature_of

# More templates than this are not looked at; the first are.
MOST_EXAMPLES = 2_000
# A word says a predicate where the two come together this often (F1 over templates).
LEAST_ASSOCIATION = 0.8
SEEN_WEIGHT = 3

Shape = tuple[str, ...]


@dataclass(frozen=True)
class TemplateExample:
    """A template with the units of its pattern; ``form`` is canonical."""

    units: tuple[Unit, ...]
    form: Form
    template: SemanticTemplate

    @cached_property
    def bag(self) -> Counter[str]:
        """How often each label occurs in the pattern."""
        return Counter(unit.label for unit in self.units)

    @cached_property
    def typed_form(self) -> Form:
        """The form with class tokens for its slots."""
        return with_classes(self.form, labels_of(self.units))


def examples_of(categories: Sequence[TaskCategory]) -> tuple[TemplateExample, ...]:
    """Return the distinct templates of task categories, at most ``MOST_EXAMPLES``, in order."""
    examples: dict[tuple[object, str], TemplateExample] = {}
    for category in categories:
        reader = UnitReader(category.grammar)
        for template in category.templates:
            key = (template.pattern, canonical_text(template.form))
            if key not in examples and len(examples) < MOST_EXAMPLES:
                units = reader.units(template.pattern)
                examples[key] = TemplateExample(units, canonicalize(template.form), template)
    return tuple(examples.values())


@dataclass(frozen=True)
class Habits:
    """Counts over examples.

    ``shapes`` counts λs by the heads of their bodies and applications by their signature; ``order`` is that of
    conjuncts; ``constraints`` the predicates of ``(predicate $1 slot)`` by the
    label of the slot; ``senses`` maps a word to the predicates that it says, with the strength in 0–1.
    """

    shapes: Counter[Shape]
    order: ConjunctOrder
    constraints: Mapping[str, Counter[str | Nonterminal]]
    senses: Mapping[str, Mapping[str, float]]

    def oddity(self, typed_form: Form) -> float:
        """Return how unusual a form is: near 1 for each new shape in it, and near 0 for a frequent one."""
        return sum(1 / (1 + SEEN_WEIGHT * self.shapes[shape]) for shape in _shapes(typed_form))

    def place(self, conjuncts: Sequence[Form], added: Form) -> tuple[Form, ...]:
        """Return the conjuncts with one more, at the place that agrees best with the usual order."""
        best = self.order.place(list(map(head_of, conjuncts)), head_of(added))
        return (*conjuncts[:best], added, *conjuncts[best:])

    def said_by(self, words: Sequence[str], names: Iterable[str]) -> frozenset[str]:
        """Return the predicates that a run of words says: by habit, or because it is their name."""
        said = {predicate for word in words for predicate in self.senses.get(word, ())}
        runs = {
            "".join(words[start:stop]) for start, stop in combinations(range(len(words) + 1), 2)
        }
        return frozenset(said | {name for name in names if name.replace("_", "") in runs})


def habits_of(examples: Sequence[TemplateExample]) -> Habits:
    """Count what is usual in examples."""
    constraints: defaultdict[str, Counter[str | Nonterminal]] = defaultdict(Counter)
    for example in examples:
        labels = labels_of(example.units)
        for conjuncts in conjunctions(example.form):
            for conjunct in conjuncts:
                match conjunct:
                    case Application(predicate, (Variable(), Wildcard() | Nonterminal() as slot)):
                        if key_of(slot) in labels:
                            constraints[labels[key_of(slot)]][predicate] += 1
    shapes = Counter(shape for each in examples for shape in _shapes(each.typed_form))
    order = order_of(each.form for each in examples)
    said: Counter[str] = Counter()
    meant: Counter[str] = Counter()
    both: Counter[tuple[str, str]] = Counter()
    for example in examples:
        units = (unit for unit in example.units if not unit.is_entity)
        words = {word for unit in units for word in words_of(unit)}
        heads = set(predicates(example.form))
        said.update(words)
        meant.update(heads)
        both.update((word, head) for word in words for head in heads)
    senses: dict[str, dict[str, float]] = {}
    for (word, head), count in both.items():
        strength = 2 * count / (said[word] + meant[head])
        if strength >= LEAST_ASSOCIATION:
            senses.setdefault(word, {})[head] = strength
    return Habits(shapes, order, constraints, senses)


def words_of(unit: Unit) -> list[str]:
    """Return the words of all phrases of a unit, in order for a single phrase."""
    return [word for phrase in sorted(unit.phrases) for word in phrase.split()]


def _shapes(typed_form: Form) -> Iterator[Shape]:
    for node in walk(typed_form):
        if isinstance(node, Lambda):
            yield ("λ", *map(head_of, node.bodies))
        elif isinstance(node, Application):
            yield (str(node.predicate), *signature_of(node).arguments)
