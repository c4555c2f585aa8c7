"""Check a changed template at little cost, to see whether a repair helps."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

from annotations.language.forms import DEFAULT_CLASSES, EntityClasses, Form, Nonterminal
from annotations.language.grammar import Budget
from annotations.language.templates.filling import fill_anonymized
from annotations.language.templates.sides import read_known_sides
from annotations.language.templates.template_checks import TemplateChecker
from annotations.language.templates.templates import SemanticTemplate
from annotations.language.texts import LanguageError, Problem, Repair

FILLINGS = 3  # of the nonterminals of a form, with which predicates are checked
FILLING_STEPS = 2_000
TRIED_COMMANDS = 20
MEMBERSHIP_STEPS = 300_000  # for all variants together


@dataclass(frozen=True, slots=True)
class Sides:
    """The two texts of a template."""

    pattern: str
    form: str

    def after(self, repair: Repair) -> Sides:
        """Return what a repair makes of both."""
        return Sides(repair.apply("pattern", self.pattern), repair.apply("form", self.form))

    def text(self, source: str) -> str:
        return self.form if source == "form" else self.pattern


class Trial:
    """Finds the problems of many variants of one template.

    It leaves out how the commands fit the grammar, and looks at a few fillings of the form alone.
    """

    def __init__(self, checker: TemplateChecker, classes: EntityClasses = DEFAULT_CLASSES) -> None:
        self.checker = checker
        self.classes = classes
        self.grammar = checker.grammar
        self.predicates = checker.predicates or {}
        self._budget = Budget(MEMBERSHIP_STEPS)
        self._known: dict[Sides, tuple[SemanticTemplate | None, tuple[Problem, ...]]] = {}
        self._words: dict[str, tuple[tuple[str, ...], ...]] = {}

    def look(self, sides: Sides) -> tuple[SemanticTemplate | None, tuple[Problem, ...]]:
        """Return the template, and the problems of its slots and predicates.

        Where a side cannot be read, None and the problems of reading.
        """
        if sides not in self._known:
            template, unread = read_known_sides(sides.pattern, sides.form, self.classes)
            if template is None:
                self._known[sides] = None, unread
            else:
                slots = self.checker.slot_problems(template)
                predicates = self.checker.predicate_problems(template, self._fillings(template))
                self._known[sides] = template, (*slots, *predicates)
        return self._known[sides]

    def outside(self, sides: Sides) -> int:
        """Return how many of the template's first commands the grammar does not have; all if none is made."""
        template, _ = self.look(sides)
        if template is None:
            return TRIED_COMMANDS
        try:
            pairs = islice(self.checker.expander.pairs(template, self._budget), TRIED_COMMANDS)
            commands = dict(pairs)
            inside = sum(self.checker.recognizer.accepts(each, self._budget) for each in commands)
        except LanguageError:
            return TRIED_COMMANDS
        return len(commands) - inside if commands else TRIED_COMMANDS

    def _fillings(self, template: SemanticTemplate) -> Iterator[Form]:
        names = sorted(template.tracked)
        words = {name: self._words_of(name) for name in names}
        count = max((len(each) for each in words.values()), default=1)
        for number in range(count):
            bindings = {name: words[name][number % len(words[name])] for name in names}
            try:
                yield fill_anonymized(template.form, bindings)
            except LanguageError:
                continue

    def _words_of(self, name: str) -> tuple[tuple[str, ...], ...]:
        """Return some of what a nonterminal becomes; no words where nothing defines it."""
        if name not in self._words:
            try:
                budget = Budget(FILLING_STEPS)
                stream = self.grammar.expander.stream((Nonterminal(name),), budget)
                self._words[name] = tuple(words for words, _ in islice(stream, FILLINGS)) or ((),)
            except LanguageError:
                self._words[name] = ((),)
        return self._words[name]
