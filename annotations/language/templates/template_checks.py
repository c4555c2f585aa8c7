"""Check semantic templates, each alone and those of a task category together (docs/reference/formats.md, Templates)."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import islice

from annotations.language.forms import (
    Form,
    Nonterminal,
    Symbols,
    Unknown,
    Wildcard,
    places_in_form,
    places_in_pattern,
    print_wildcard,
    read_spans,
    slot_key,
)
from annotations.language.grammar import (
    CHECK_STEPS,
    Budget,
    Grammar,
    Recognizer,
    TooManyCombinations,
    recognizer_of,
)
from annotations.language.templates.expansion import Conflict, Generated, TaskCategory
from annotations.language.templates.filling import bare
from annotations.language.templates.grammar_expansions import (
    DEFAULT_LIMIT,
    MOST_ENUMERATED,
    GrammarExpansions,
    too_many_commands,
)
from annotations.language.templates.line_checks import (
    composition_problems,
    find_loose_references,
    line_problems,
)
from annotations.language.templates.synchronous import STAND_IN, TemplateExpander
from annotations.language.templates.templates import SemanticTemplate
from annotations.language.texts import (
    LanguageError,
    Offsets,
    Position,
    Problem,
    error_at,
    say_count,
    warning_at,
)
from annotations.language.world import (
    Misuse,
    Predicate,
    PredicateKind,
    Signature,
    find_misuses,
    infer_signatures,
)

# A template is checked as it is typed, so only this many of its pairs are looked at.
CHECKED_PAIRS = 2_000
# Recognising a command takes as long as making many, so few are recognised where the grammar is large.
MOST_RECOGNISED = 200
MOST_PREDICATE_PROBLEMS = 50
# For all templates of a world together. A hundred published templates take 50,000.
SET_STEPS = 50_000_000


@dataclass(frozen=True)
class TemplateChecker:
    """Checks templates against one grammar and, if they are known, declared predicates.

    Use ``template_checker`` to make one. ``limit`` is how many commands a template may make by itself; None
    where the commands are a sample, which leaves no template out.
    """

    grammar: Grammar
    expander: TemplateExpander
    recognizer: Recognizer | GrammarExpansions
    predicates: Mapping[str, Predicate] | None = None
    task_category: str = ""
    limit: int | None = DEFAULT_LIMIT

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
            too_many = too_many_commands(template, self.expander.size(template), self.limit)
            if too_many is not None:
                problems.append(too_many)
            commands, texts, forms = self._expand(template, budget)
            problems.extend(self._membership(template, commands, budget))
            problems.extend(self.predicate_problems(template, forms))
            problems.extend(find_loose_references(template, texts))
        except TooManyCombinations as error:
            return (*problems, replace(error.problem, position=template.position))
        except LanguageError as error:
            return (*problems, error.problem)
        return tuple(problems)

    def _expand(
        self, template: SemanticTemplate, budget: Budget
    ) -> tuple[list[str], Collection[str], Collection[Form]]:
        """Return the first commands of the template, their distinct forms and those of the template's own terms.

        They are looked up where they are kept.
        """
        known = self.recognizer
        if isinstance(known, GrammarExpansions) and known.has(template):
            made = known.made(template, budget)
            if made.n_pairs < CHECKED_PAIRS and made.steps <= CHECK_STEPS:
                texts = dict.fromkeys(text for each in made.pairs.values() for text in each)
                return list(made.pairs), texts, made.own_forms
        pairs = list(islice(self.expander.filled_pairs(template, budget), CHECKED_PAIRS))
        texts = dict.fromkeys(filled.text for _, filled in pairs)
        own = dict.fromkeys(filled.own for _, filled in pairs)
        return [" ".join(words) for words, _ in pairs], texts, own

    def slot_problems(self, template: SemanticTemplate) -> Iterator[Problem]:
        """Yield what is wrong with the slots of both sides, without expanding anything."""
        rules = self.expander.rules
        spoken = rules.words.spoken(template.pattern)
        yield from composition_problems(template, rules)
        keys = {slot_key(symbol) for symbol in spoken} - {None}
        for key, slot in {slot_key(slot): slot for slot in template.slots()}.items():
            if key in keys:
                continue
            places = places_in_form(template.form_text)
            start = next((each.start for each in places if each.key == slot_key(slot)), 0)
            yield error_at(
                Offsets(template.form_text).position(start).inside(template.form_position),
                f"the form mentions {_print(slot)}, which the pattern never produces",
                "add it to the pattern, or write a value in the form",
            )
        said = {slot_key(slot) for slot in template.slots()}
        left_out: dict[object, Wildcard] = {}
        for symbol in rules.words.spoken(template.pattern, opaque=template.tracked):
            if not isinstance(symbol, Wildcard) or slot_key(symbol) in said:
                continue
            if symbol.entity_class:
                left_out.setdefault(slot_key(symbol), symbol)
        for wildcard in left_out.values() if not isinstance(template.form, Unknown) else ():
            yield warning_at(
                _place_in_pattern(template, wildcard),
                f"the command says {_print(wildcard)}, but the form leaves it out",
                "ignore this if intended",
            )
        for symbol in spoken:
            if isinstance(symbol, Nonterminal) and symbol.name not in rules.words.rules:
                yield warning_at(
                    _place_in_pattern(template, symbol),
                    f"nothing defines {symbol}",
                    "what uses it makes no commands",
                )

    def _membership(
        self, template: SemanticTemplate, commands: list[str], budget: Budget
    ) -> Iterator[Problem]:
        name = template.nonterminal
        if name and name not in self.grammar.rules:
            return
        # A line may become nothing, which is no command where the line is one for the root.
        is_inside = all(commands) and self.expander.rules.is_inside(template)
        recognizer = self.recognizer
        if name and not is_inside:
            recognizer = recognizer_of(self.grammar, name)
        judged: list[tuple[str, bool]] = []  # each command and whether it is in the grammar
        with suppress(TooManyCombinations):  # the others are not judged
            distinct = tuple(dict.fromkeys(commands))
            is_large = self.grammar.size() > MOST_ENUMERATED
            step = max(1, len(distinct) // MOST_RECOGNISED) if is_large else 1
            for command in distinct[::step]:
                judged.append((command, is_inside or recognizer.accepts(command, budget)))
        outside = [command for command, is_inside in judged if not is_inside]
        if not commands:
            yield warning_at(
                template.position, "the template makes no command", "check its pattern"
            )
        elif judged and len(outside) == len(judged):
            name = (
                f"task category {self.task_category}" if self.task_category else "the task category"
            )
            inside = (
                f"what ${template.nonterminal} becomes" if template.nonterminal else "the grammar"
            )
            warning = warning_at(
                template.position,
                f'the pattern matches nothing in {inside}; it makes "{outside[0]}"',
                f"see the productions of {name}",
            )
            yield replace(warning, task_category=self.task_category)
        elif outside:
            is_cut = len(commands) == CHECKED_PAIRS or len(judged) < len(set(commands))
            some = " that were looked at" if is_cut else ""
            yield warning_at(
                template.position,
                f"{len(outside)} of {len(judged)} commands{some} are outside the grammar, "
                f'such as "{outside[0]}"',
                "they are kept; narrow the pattern if this is not intended",
            )

    def predicate_problems(
        self, template: SemanticTemplate, forms: Iterable[Form]
    ) -> Iterator[Problem]:
        """Yield how the forms, fillings of the template's own, misuse predicates, each at its place."""
        if self.predicates is None:
            return
        misuses: dict[Misuse, None] = {}
        known = {
            **self.predicates,
            STAND_IN: Predicate(STAND_IN, PredicateKind.ACTION, (Signature(()),)),
        }
        for form in forms:
            misuses.update(dict.fromkeys(find_misuses(form, known)))
            if len(misuses) >= MOST_PREDICATE_PROBLEMS:
                break
        for misuse in misuses:
            span = list(read_spans(template.form_text).walk())[misuse.node]
            start = span.name_start if span.kind == "application" else span.start
            place = Offsets(template.form_text).position(start).inside(template.form_position)
            warning = warning_at(place, misuse.message, misuse.hint)
            yield replace(warning, undeclared=misuse.undeclared)

    def predicates_used(self, template: SemanticTemplate) -> Mapping[str, Predicate]:
        """Return the predicates of a form as it uses them, with the signatures that its commands show.

        A pattern that is too large, or has an error, shows those of the form as it is written.
        """
        try:
            _, _, forms = self._expand(template, Budget(CHECK_STEPS))
        except LanguageError:
            forms = ()
        return infer_signatures(forms or (template.form,))


def template_checker(
    grammar: Grammar,
    predicates: Mapping[str, Predicate] | None = None,
    task_category: str = "",
    lines: tuple[SemanticTemplate, ...] = (),
) -> TemplateChecker:
    """Return a checker for many templates of one grammar; ``task_category`` is its name in hints.

    Raises:
        LanguageError: the grammar, or the lines, have a cycle.
    """
    expander, recognizer = TemplateExpander(grammar, lines), recognizer_of(grammar)
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


def _place_in_pattern(template: SemanticTemplate, slot: Nonterminal | Wildcard) -> Position:
    """Return where the slot is in the pattern, or its start if a nonterminal brings the slot in."""
    places = places_in_pattern(template.pattern_text)
    start = next((each.start for each in places if each.key == slot_key(slot)), 0)
    return template.position.shifted(start)


def set_problems(
    categories: Sequence[TaskCategory],
    generated: Generated,
    predicates: Mapping[str, Predicate] | None = None,
) -> tuple[Problem, ...]:
    """Return every problem of the templates, in the order of their places.

    Args:
        generated: what ``generate`` made of the same categories.

    A template that several categories use is checked against the grammar of the first.
    """
    problems: dict[Problem, None] = {}
    spent = 0
    checked: set[tuple[object, SemanticTemplate]] = set()
    for category in categories:
        checker = template_checker(category.grammar, predicates, category.name, category.lines)
        for template in category.templates:
            if (template.position, template) in checked:
                continue
            checked.add((template.position, template))
            budget = Budget(CHECK_STEPS)
            problems.update(dict.fromkeys(checker.problems(template, budget)))
            spent += budget.spent
            if spent > SET_STEPS:
                return (
                    *sorted(problems),
                    error_at(
                        template.position,
                        "too many combinations to check; the templates from here on are not checked",
                        "narrow the patterns above",
                    ),
                )
        problems.update((problem, None) for _, problem in shared_problems(category, generated))
    return tuple(sorted(problems))


def shared_problems(category: TaskCategory, generated: Generated) -> Iterator[tuple[int, Problem]]:
    """Yield (template index, problem) of what a template has with others: duplicates, conflicts, unused lines."""
    yield from line_problems(category)
    first: dict[tuple[str, Symbols, str], SemanticTemplate] = {}
    for index, template in enumerate(category.templates):
        key = (template.nonterminal, template.pattern, template.form_text)
        earlier = first.setdefault(key, template)
        if earlier is not template:
            yield (
                index,
                warning_at(
                    template.position,
                    f"duplicate of {earlier.position}",
                    "remove one of the two",
                ),
            )
    # Yield one problem for each pair of templates that disagree, with a command as an example.
    pairs: dict[tuple[int, int], list[Conflict]] = {}
    for conflict in generated.conflicts:
        if conflict.task_category == category.name:
            *losing, (winner, _) = conflict.candidates
            for loser, _ in losing:
                pairs.setdefault((loser, winner), []).append(conflict)
    for (loser, winner), conflicts in pairs.items():
        commands = say_count(len(conflicts), "command")
        yield (
            winner,
            warning_at(
                category.templates[winner].position,
                f'{commands} such as "{conflicts[0].command}" with a different form '
                f"at {category.templates[loser].position}",
                "the later form is kept; correct the one that is wrong",
            ),
        )
