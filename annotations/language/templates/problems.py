"""Automatic checks of one semantic template (FORMATS §3)."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import islice

from annotations.language.errors import (
    LanguageError,
    Offsets,
    Position,
    Problem,
    error_at,
    warning_at,
)
from annotations.language.forms import Form, Unknown, read_spans
from annotations.language.grammar import (
    CHECK_STEPS,
    Budget,
    Grammar,
    Recognizer,
    TooManyCombinations,
)
from annotations.language.predicates import Misuse, Predicate, find_misuses
from annotations.language.symbols import (
    Nonterminal,
    Wildcard,
    places_in_form,
    places_in_pattern,
    print_wildcard,
    slot_key,
)
from annotations.language.templates.filling import bare
from annotations.language.templates.grammar_expansions import (
    DEFAULT_LIMIT,
    GrammarExpansions,
    too_many_commands,
)
from annotations.language.templates.synchronous import TemplateExpander
from annotations.language.templates.templates import SemanticTemplate

# A template is checked as it is typed, so only this many of its pairs are looked at.
CHECKED_PAIRS = 2_000
MOST_PREDICATE_PROBLEMS = 50


@dataclass(frozen=True)
class TemplateChecker:
    """Checks templates against one grammar and, if they are known, declared predicates.

    Use ``template_checker`` to make one.
    """

    grammar: Grammar
    expander: TemplateExpander
    recognizer: Recognizer | GrammarExpansions
    predicates: Mapping[str, Predicate] | None = None
    task_category: str = ""

    def problems(
        self, template: SemanticTemplate, budget: Budget | None = None
    ) -> tuple[Problem, ...]:
        """Check slots, undefined nonterminals, predicates, and how the commands fit the grammar.

        A slot that only the form has is an error, and so is a pattern with more combinations than
        ``budget`` (``CHECK_STEPS`` by default) allows; everything else is a warning. Unbound
        variables are not checked here: a form with one cannot be read.
        """
        problems = list(self.slot_problems(template))
        if any(problem.is_error for problem in problems):
            return tuple(problems)
        budget = budget or Budget(CHECK_STEPS)
        try:
            too_many = too_many_commands(template, self.expander.size(template), DEFAULT_LIMIT)
            if too_many is not None:
                problems.append(too_many)
            commands, forms = self._expand(template, budget)
            problems.extend(self._membership(template, commands, budget))
            problems.extend(self.predicate_problems(template, forms))
        except TooManyCombinations as error:
            return (*problems, replace(error.problem, position=template.position))
        except LanguageError as error:
            return (*problems, error.problem)
        return tuple(problems)

    def _expand(
        self, template: SemanticTemplate, budget: Budget
    ) -> tuple[list[str], Collection[Form]]:
        """Return the first commands of the template and its distinct forms, looked up where they are kept."""
        known = self.recognizer
        if isinstance(known, GrammarExpansions) and known.has(template):
            made = known.made(template, budget)
            if made.n_pairs < CHECKED_PAIRS and made.steps <= CHECK_STEPS:
                return list(made.pairs), made.forms
        pairs = list(islice(self.expander.filled_pairs(template, budget), CHECKED_PAIRS))
        forms = {filled.text: filled.form for _, filled in pairs}
        return [" ".join(words) for words, _ in pairs], forms.values()

    def slot_problems(self, template: SemanticTemplate) -> Iterator[Problem]:
        """Yield what is wrong with the slots of both sides, without expanding anything."""
        yield from self._slots_of_the_form_only(template)
        yield from self._wildcards_of_the_pattern_only(template)
        yield from self._undefined_nonterminals(template)

    def _slots_of_the_form_only(self, template: SemanticTemplate) -> Iterator[Problem]:
        spoken = self.grammar.spoken(template.pattern)
        keys = {slot_key(symbol) for symbol in spoken} - {None}
        for key, slot in {slot_key(slot): slot for slot in template.slots()}.items():
            if key in keys:
                continue
            yield error_at(
                _place_in_form(template, slot),
                f"the form mentions {_print(slot)}, which the pattern never produces",
                "add it to the pattern, or write a value in the form",
            )

    def _wildcards_of_the_pattern_only(self, template: SemanticTemplate) -> Iterator[Problem]:
        if isinstance(template.form, Unknown):
            return
        said = {slot_key(slot) for slot in template.slots()}
        missing: dict[object, Wildcard] = {}
        for symbol in self.grammar.spoken(template.pattern, opaque=template.tracked):
            if (
                isinstance(symbol, Wildcard)
                and symbol.entity_class
                and slot_key(symbol) not in said
            ):
                missing.setdefault(slot_key(symbol), symbol)
        for wildcard in missing.values():
            yield warning_at(
                _place_in_pattern(template, wildcard),
                f"the command says {_print(wildcard)}, but the form leaves it out",
                "ignore this if intended",
            )

    def _undefined_nonterminals(self, template: SemanticTemplate) -> Iterator[Problem]:
        for symbol in self.grammar.spoken(template.pattern):
            if isinstance(symbol, Nonterminal) and symbol.name not in self.grammar.rules:
                yield warning_at(
                    _place_in_pattern(template, symbol),
                    f"nothing defines {symbol}",
                    "what uses it makes no commands",
                )

    def _membership(
        self, template: SemanticTemplate, commands: list[str], budget: Budget
    ) -> Iterator[Problem]:
        judged = self._judge(dict.fromkeys(commands), budget)
        outside = [command for command, is_inside in judged if not is_inside]
        if not commands:
            yield warning_at(
                template.position, "the template makes no command", "check its pattern"
            )
        elif judged and len(outside) == len(judged):
            warning = warning_at(
                template.position,
                f'the pattern matches nothing in the grammar; it makes "{outside[0]}"',
                f"see the productions of {self._category()}",
            )
            yield replace(warning, task_category=self.task_category)
        elif outside:
            is_cut = len(commands) == CHECKED_PAIRS or len(judged) < len(set(commands))
            first = "the first " if is_cut else ""
            yield warning_at(
                template.position,
                f"{len(outside)} of {first}{len(judged)} commands are outside the grammar, "
                f'such as "{outside[0]}"',
                "they are kept; narrow the pattern if this is not intended",
            )

    def _category(self) -> str:
        return f"task category {self.task_category}" if self.task_category else "the task category"

    def _judge(self, commands: Iterable[str], budget: Budget) -> list[tuple[str, bool]]:
        """Return each command and whether it is in the grammar, until the budget is spent."""
        judged: list[tuple[str, bool]] = []
        try:
            for command in commands:
                judged.append((command, self.recognizer.accepts(command, budget)))
        except TooManyCombinations:
            pass
        return judged

    def predicate_problems(
        self, template: SemanticTemplate, forms: Iterable[Form]
    ) -> Iterator[Problem]:
        """Yield how the forms, fillings of the template's own, misuse predicates, each at its place."""
        if self.predicates is None:
            return
        misuses: dict[Misuse, None] = {}
        for form in forms:
            misuses.update(dict.fromkeys(find_misuses(form, self.predicates)))
            if len(misuses) >= MOST_PREDICATE_PROBLEMS:
                break
        for misuse in misuses:
            yield warning_at(_place_of_node(template, misuse.node), misuse.message, misuse.hint)


def template_checker(
    grammar: Grammar,
    predicates: Mapping[str, Predicate] | None = None,
    task_category: str = "",
) -> TemplateChecker:
    """Return a checker for many templates of one grammar; ``task_category`` is its name in hints.

    Raises:
        LanguageError: the grammar has a cycle.
    """
    expander, recognizer = TemplateExpander(grammar), Recognizer(grammar)
    return TemplateChecker(grammar, expander, recognizer, predicates, task_category)


def problems(
    template: SemanticTemplate,
    grammar: Grammar,
    predicates: Mapping[str, Predicate] | None = None,
) -> tuple[Problem, ...]:
    """Return the problems of one template. See ``TemplateChecker.problems``."""
    return template_checker(grammar, predicates).problems(template)


def _print(symbol: Nonterminal | Wildcard) -> str:
    return str(symbol) if isinstance(symbol, Nonterminal) else print_wildcard(bare(symbol))


def _place_in_form(template: SemanticTemplate, slot: Nonterminal | Wildcard) -> Position:
    places = places_in_form(template.form_text)
    start = next((each.start for each in places if each.key == slot_key(slot)), 0)
    return Offsets(template.form_text).position(start).inside(template.form_position)


def _place_in_pattern(template: SemanticTemplate, slot: Nonterminal | Wildcard) -> Position:
    """Return where the slot is in the pattern, or its start if a nonterminal brings the slot in."""
    places = places_in_pattern(template.pattern_text)
    start = next((each.start for each in places if each.key == slot_key(slot)), 0)
    return template.position.shifted(start)


def _place_of_node(template: SemanticTemplate, node: int) -> Position:
    """Return where a term is in the form, by its number in the order of ``walk``.

    Filling a form keeps these numbers. The place of an application is that of its predicate.
    """
    span = list(read_spans(template.form_text).walk())[node]
    start = span.name_start if span.kind == "application" else span.start
    return Offsets(template.form_text).position(start).inside(template.form_position)
