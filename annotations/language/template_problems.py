"""What can be said against one semantic template without a person (FORMATS §3)."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import islice

from annotations.language.errors import LanguageError, Position, Problem, error, warning
from annotations.language.filling import bare
from annotations.language.grammar import Grammar
from annotations.language.logic import Unknown, read_form
from annotations.language.predicates import Predicate, check_form
from annotations.language.printing import print_wildcard
from annotations.language.recognizer import Recognizer
from annotations.language.symbols import Nonterminal, Wildcard
from annotations.language.synchronous import TemplateExpander
from annotations.language.templates import SemanticTemplate

# A template is checked as it is typed, so only this many of its pairs are looked at.
CHECKED_PAIRS = 2_000


@dataclass(frozen=True)
class TemplateChecker:
    """Checks templates against one grammar and, where they are known, declared predicates.

    Use ``template_checker`` to make one.
    """

    grammar: Grammar
    expander: TemplateExpander
    recognizer: Recognizer
    predicates: Mapping[str, Predicate] | None = None

    def problems(self, template: SemanticTemplate) -> tuple[Problem, ...]:
        """Slots, undefined nonterminals, predicates, and how the commands fit the grammar.

        A slot that only the form has is an error; everything else is a warning. Unbound variables
        are no matter here: a form that has one is not read in the first place.
        """
        found = [
            *self._slots_of_the_form_only(template),
            *self._wildcards_of_the_pattern_only(template),
            *self._undefined(template),
        ]
        if any(problem.is_error for problem in found):
            return tuple(found)
        try:
            pairs = list(islice(self.expander.pairs(template), CHECKED_PAIRS))
        except LanguageError as trouble:
            return (*found, trouble.problem)
        found.extend(self._membership(template, pairs))
        found.extend(self._predicates(template, dict.fromkeys(form for _, form in pairs)))
        return tuple(found)

    def _slots_of_the_form_only(self, template: SemanticTemplate) -> Iterator[Problem]:
        spoken = self.grammar.spoken(template.pattern)
        keys = {_key(symbol) for symbol in spoken} - {None}
        for key, slot in {_key(slot): slot for slot in template.slots()}.items():
            if key in keys:
                continue
            yield error(
                _place(template.form_text, slot, template.form_position),
                f"the form mentions {_printed(slot)}, which the pattern never produces",
                "put it into the pattern, or give the form a value",
            )

    def _wildcards_of_the_pattern_only(self, template: SemanticTemplate) -> Iterator[Problem]:
        if isinstance(template.form, Unknown):
            return
        said = {_key(slot) for slot in template.slots()}
        found: dict[object, Wildcard] = {}
        for symbol in self.grammar.spoken(template.pattern, opaque=template.tracked):
            if isinstance(symbol, Wildcard) and symbol.entity_class and _key(symbol) not in said:
                found.setdefault(_key(symbol), symbol)
        for wildcard in found.values():
            yield warning(
                _place(template.pattern_text, wildcard, template.position),
                f"the command says {_printed(wildcard)}, but the form leaves it out",
                "nothing to do where the form means to leave it out",
            )

    def _undefined(self, template: SemanticTemplate) -> Iterator[Problem]:
        for symbol in self.grammar.spoken(template.pattern):
            if isinstance(symbol, Nonterminal) and symbol.name not in self.grammar.rules:
                yield warning(
                    _place(template.pattern_text, symbol, template.position),
                    f"nothing defines {symbol}",
                    "what reaches it yields no command",
                )

    def _membership(
        self, template: SemanticTemplate, pairs: list[tuple[str, str]]
    ) -> Iterator[Problem]:
        distinct = dict.fromkeys(command for command, _ in pairs)
        outside = [command for command in distinct if not self.recognizer.accepts(command)]
        if not distinct:
            yield warning(template.position, "the template makes no command", "check its pattern")
        elif len(outside) == len(distinct):
            yield warning(
                template.position,
                f'the pattern matches nothing in the grammar; it makes "{outside[0]}"',
                "compare it with the productions",
            )
        elif outside:
            first = "the first " if len(pairs) == CHECKED_PAIRS else ""
            yield warning(
                template.position,
                f"{len(outside)} of {first}{len(distinct)} commands are outside the grammar, "
                f'such as "{outside[0]}"',
                "they are kept; narrow the pattern if they are not meant",
            )

    def _predicates(
        self, template: SemanticTemplate, form_texts: Mapping[str, None]
    ) -> Iterator[Problem]:
        if self.predicates is None:
            return
        found: dict[Problem, None] = {}
        for text in form_texts:
            form = read_form(text)
            found.update(dict.fromkeys(check_form(form, self.predicates, template.form_position)))
        yield from found


def template_checker(
    grammar: Grammar, predicates: Mapping[str, Predicate] | None = None
) -> TemplateChecker:
    """A checker that can be used for many templates of one grammar.

    Raises:
        LanguageError: the grammar has a cycle.
    """
    return TemplateChecker(grammar, TemplateExpander(grammar), Recognizer(grammar), predicates)


def problems(
    template: SemanticTemplate,
    grammar: Grammar,
    predicates: Mapping[str, Predicate] | None = None,
) -> tuple[Problem, ...]:
    """The problems of one template. See ``TemplateChecker.problems``."""
    return template_checker(grammar, predicates).problems(template)


def _key(symbol: Nonterminal | Wildcard) -> object:
    """What a slot and its source have in common; None for what supplies no value."""
    if isinstance(symbol, Nonterminal):
        return symbol
    return None if symbol.kind == "void" else symbol.identity


def _printed(symbol: Nonterminal | Wildcard) -> str:
    return str(symbol) if isinstance(symbol, Nonterminal) else print_wildcard(bare(symbol))


def _place(text: str, symbol: Nonterminal | Wildcard, start: Position) -> Position:
    """Where the symbol stands in the text, the start of the text where it is further down."""
    if isinstance(symbol, Nonterminal):
        found = re.search(rf"\${symbol.name}\b", text)
        return start.shifted(found.start() if found else 0)
    identifier = "" if symbol.id is None else str(symbol.id)
    for brace in re.finditer(r"\{\s*(\w+)[^{}\d]*(\d*)", text):
        if brace[1].lower() == symbol.name and brace[2] == identifier:
            return start.shifted(brace.start())
    return start
