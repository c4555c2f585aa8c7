"""Repairs for predicates and variables: another name, other arguments, a λ around them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, islice

from annotations.language.forms import (
    NOUN,
    TermSpan,
    places_in_form,
    print_symbol,
    read_spans,
)
from annotations.language.grammar import Grammar
from annotations.language.templates.candidates import (
    FORM,
    RepairCandidate,
    candidate,
    insert,
    nearest,
    shorten,
)
from annotations.language.templates.slot_repairs import in_place_of
from annotations.language.templates.templates import SemanticTemplate
from annotations.language.texts import TextEdit
from annotations.language.world import ArgumentKind, Predicate, PredicateKind

MOST_SLOTS = 6
MOST_DESCRIPTIONS = 12


@dataclass(frozen=True)
class FormText:
    """The text of a form, whose variables need not be bound, and its subterms."""

    text: str

    @cached_property
    def spans(self) -> tuple[TermSpan, ...]:
        return tuple(read_spans(self.text).walk())

    def of(self, span: TermSpan) -> str:
        return self.text[span.start : span.end]

    def at(self, offset: int) -> TermSpan | None:
        """Return the smallest subterm around ``offset``."""
        around = [each for each in self.spans if each.start <= offset < each.end]
        return min(around, key=lambda each: each.end - each.start, default=None)

    def parent(self, span: TermSpan) -> TermSpan | None:
        return next((each for each in self.spans if span in each.children), None)

    def new_variable(self) -> str:
        used = {each.name for each in self.spans}
        return next(f"${n}" for n in range(1, 100) if f"${n}" not in used)

    def bound_around(self, span: TermSpan) -> list[str]:
        """Return the variables whose λ is around ``span``, the nearest first."""
        around = [
            each
            for each in self.spans
            if each.kind == "abstraction" and each.start < span.start and each.end >= span.end
        ]
        return [each.name for each in reversed(around)]


def misuse(
    template: SemanticTemplate,
    predicates: Mapping[str, Predicate],
    grammar: Grammar,
    offset: int,
) -> Iterator[RepairCandidate]:
    """Yield candidates for the application, or the argument of one, at ``offset`` of the form."""
    form = FormText(template.form_text)
    span = form.at(offset)
    if span is None:
        return
    is_head = span.kind == "application" and span.name_start <= offset < span.name_end
    parent = None if is_head else form.parent(span)
    application = parent if parent and parent.kind == "application" else span
    if application.kind != "application":
        return
    yield from _rename_predicate(form, application, predicates)
    if application.name not in predicates:
        return  # other arguments would not make it known
    yield from _exchange(form, application)
    for argument in application.children:
        start = len(form.text[: argument.start].rstrip())
        label = f"Remove {shorten(form.of(argument))} from {application.name}"
        yield candidate(label, [TextEdit(FORM, start, argument.end, "")], 1.0)
    yield from _add_arguments(form, application, template, grammar)
    for argument in application.children if is_head else (span,):
        yield from _wrap(form, argument, predicates)
        yield from _unwrap(form, argument)
        for slot in list(in_place_of(template, grammar, None))[:MOST_SLOTS]:
            text = print_symbol(slot)
            edit = TextEdit(FORM, argument.start, argument.end, text)
            yield candidate(f"Write {text} for {shorten(form.of(argument))}", [edit], 1.2)


def unbound(form_text: str, offset: int) -> Iterator[RepairCandidate]:
    """Yield candidates for the variable at ``offset``, which no λ binds."""
    form = FormText(form_text)
    span = form.at(offset)
    if span is None or span.kind != "variable":
        return
    bound = dict.fromkeys([*form.bound_around(span), *_bound_variables(form)])
    for number, name in enumerate(bound):
        edits = [
            TextEdit(FORM, each.start, each.end, name)
            for each in form.spans
            if each.kind == "variable" and each.name == span.name and each.start >= span.start
        ]
        yield candidate(f"Write {name} for {span.name}", edits[:1], 0.1 + number / 10)
        yield candidate(f"Write {name} for every {span.name}", edits, 0.2 + number / 10)
    inner = form.parent(span) if span.name not in _bound_variables(form) else None
    while inner is not None:
        outer = form.parent(inner)
        siblings = outer.children if outer else (inner,)
        run = [
            each
            for each in siblings
            if ("variable", span.name) in {(part.kind, part.name) for part in each.walk()}
        ]
        start, end = run[0].start, run[-1].end
        edits = [insert(FORM, start, f"(λ{span.name}:e "), insert(FORM, end, ")")]
        rank = 0.5 if outer else 2.0
        yield candidate(f"Put λ{span.name} around {shorten(form.text[start:end])}", edits, rank)
        inner = outer


def _bound_variables(form: FormText) -> list[str]:
    return [each.name for each in form.spans if each.kind == "abstraction"]


def _rename_predicate(
    form: FormText, application: TermSpan, predicates: Mapping[str, Predicate]
) -> Iterator[RepairCandidate]:
    """Rename the predicate, wherever it stands if nothing declares it."""
    name = application.name
    same = [
        each
        for each in form.spans
        if each.kind == "application" and each.name == name and name not in predicates
    ]
    for other, rank in nearest(name, predicates, 8):
        edits = [
            TextEdit(FORM, each.name_start, each.name_end, other) for each in same or [application]
        ]
        yield candidate(f"Write {other} for {name}", edits, rank + (name in predicates) / 2)


def _exchange(form: FormText, application: TermSpan) -> Iterator[RepairCandidate]:
    """Exchange two arguments, or two slots wherever the form has them."""
    for one, other in combinations(application.children, 2):
        texts = form.of(one), form.of(other)
        edits = [
            TextEdit(FORM, one.start, one.end, texts[1]),
            TextEdit(FORM, other.start, other.end, texts[0]),
        ]
        yield candidate(f"Exchange {shorten(texts[0])} and {shorten(texts[1])}", edits, 0.2)
    places = places_in_form(form.text)
    slots = {place.key: form.text[place.start : place.end] for place in places}
    for first, second in islice(combinations(slots, 2), MOST_SLOTS):
        into = {first: slots[second], second: slots[first]}
        edits = [TextEdit(FORM, p.start, p.end, into[p.key]) for p in places if p.key in into]
        label = f"Exchange {shorten(slots[first])} and {shorten(slots[second])}"
        yield candidate(label, edits, 0.25)


def _add_arguments(
    form: FormText, application: TermSpan, template: SemanticTemplate, grammar: Grammar
) -> Iterator[RepairCandidate]:
    """Add a variable in front or a slot behind, for what takes more arguments."""
    for name in form.bound_around(application)[:2]:
        edit = insert(FORM, application.name_end, f" {name}")
        yield candidate(f"Add {name} to {application.name}", [edit], 0.3)
    at = application.children[-1].end if application.children else application.name_end
    for number, slot in enumerate(in_place_of(template, grammar, None)):
        if number < MOST_SLOTS:
            text = print_symbol(slot)
            yield candidate(
                f"Add {text} to {application.name}",
                [insert(FORM, at, f" {text}")],
                0.8 + number / 100,
            )


def _wrap(
    form: FormText, argument: TermSpan, predicates: Mapping[str, Predicate]
) -> Iterator[RepairCandidate]:
    """Describe a value by a λ: ``{kobject}`` becomes ``(λ$1:e (is_a $1 {kobject}))``."""
    variable, text = form.new_variable(), form.of(argument)
    descriptions = [
        name
        for name, each in predicates.items()
        if each.kind == PredicateKind.DESCRIPTION
        and any(
            len(signature.arguments) == 2 and signature.arguments[0] == ArgumentKind.VARIABLE
            for signature in each.signatures
        )
    ]
    first = sorted(descriptions, key=lambda name: (name != NOUN, name))
    for number, name in enumerate(first[:MOST_DESCRIPTIONS]):
        whole = f"(λ{variable}:e ({name} {variable} {text}))"
        edit = TextEdit(FORM, argument.start, argument.end, whole)
        yield candidate(f"Write {shorten(whole, 40)}", [edit], 0.4 + number / 100)


def _unwrap(form: FormText, argument: TermSpan) -> Iterator[RepairCandidate]:
    """Take the value out of its description: the other way of ``_wrap``."""
    if argument.kind != "abstraction" or len(argument.children) != 1:
        return
    for value in argument.children[0].children:
        if value.kind in ("slot", "nonterminal", "text", "integer"):
            text = form.of(value)
            yield candidate(
                f"Write {text} alone", [TextEdit(FORM, argument.start, argument.end, text)], 0.4
            )
