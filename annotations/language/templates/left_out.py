"""Repairs for a slot that the form leaves out: put where other templates have one of its class."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from annotations.language.forms import (
    CONJUNCTION,
    Application,
    ConjunctOrder,
    Nonterminal,
    Variable,
    Wildcard,
    order_of,
    places_in_pattern,
    print_symbol,
    slot_key,
    walk,
)
from annotations.language.grammar import Grammar
from annotations.language.templates.candidates import (
    FORM,
    RepairCandidate,
    candidate,
    insert,
    shorten,
)
from annotations.language.templates.filling import bare
from annotations.language.templates.templates import SemanticTemplate
from annotations.language.templates.term_repairs import FormText
from annotations.language.texts import TextEdit

MOST_USES = 4  # of one class that are tried


@dataclass(frozen=True, slots=True)
class _Use:
    """How a form says a slot: ``(predicate $v slot)`` about a variable, or as argument ``place`` of an action."""

    predicate: str
    place: int
    is_constraint: bool


@dataclass(frozen=True)
class Usage:
    """How the forms of other templates say slots: ``uses`` by entity class, and the order of conjuncts."""

    uses: Mapping[str, Counter[_Use]]
    order: ConjunctOrder


def no_usage() -> Usage:
    """Return the usage of no templates."""
    return Usage({}, ConjunctOrder(Counter()))


def usage_of(templates: Sequence[SemanticTemplate], grammar: Grammar) -> Usage:
    """Count how ``templates`` say the slots of each entity class."""
    uses: defaultdict[str, Counter[_Use]] = defaultdict(Counter)
    for template in templates:
        for term in walk(template.form):
            if isinstance(term, Application) and isinstance(term.predicate, str):
                for place, argument in enumerate(term.arguments):
                    use = _Use(term.predicate, place, Variable in map(type, term.arguments))
                    if not isinstance(argument, Wildcard | Nonterminal):
                        continue
                    produced = grammar.spoken((argument,))
                    classes = {each.entity_class for each in produced if isinstance(each, Wildcard)}
                    for entity_class in classes - {""}:
                        uses[entity_class][use] += 1
    return Usage(uses, order_of(each.form for each in templates))


def left_out(
    template: SemanticTemplate, usage: Callable[[], Usage], grammar: Grammar, offset: int
) -> Iterator[RepairCandidate]:
    """Yield candidates for the slots at ``offset`` of the pattern, which the form does not mention.

    A nonterminal comes before the wildcards that it produces. What a nonterminal produces has its
    problem at the start of the pattern.
    """
    wanted: dict[str, str] = {}  # the slot as a form writes it → its entity class
    said = {slot_key(slot) for slot in template.slots()}
    for place in places_in_pattern(template.pattern_text):
        if place.key in said or (isinstance(place.slot, Wildcard) and place.start != offset):
            continue
        produced = grammar.spoken((place.slot,))
        classes = [each for each in produced if isinstance(each, Wildcard) and each.entity_class]
        if classes and not any(slot_key(each) in said for each in classes):
            slot = bare(place.slot) if isinstance(place.slot, Wildcard) else place.slot
            wanted[print_symbol(slot)] = classes[0].entity_class
    if not wanted:
        return
    known = usage()
    form = FormText(template.form_text)
    for text, entity_class in wanted.items():
        common = known.uses.get(entity_class, Counter[_Use]()).most_common(MOST_USES)
        for number, (use, _) in enumerate(common):
            put = (
                _conjoin(form, use, text, known.order)
                if use.is_constraint
                else _add(form, use, text)
            )
            yield from (candidate(label, [edit], number / 10 - rank) for label, edit, rank in put)


def _conjoin(
    form: FormText, use: _Use, slot: str, order: ConjunctOrder
) -> Iterator[tuple[str, TextEdit, float]]:
    """Yield label, edit and likelihood of one more conjunct, for each λ: more likely beside usual company."""
    for span in form.spans:
        if span.kind != "abstraction":
            continue
        is_and = len(span.children) == 1 and span.children[0].name == CONJUNCTION
        conjuncts = span.children[0].children if is_and else span.children
        heads = [each.name for each in conjuncts]
        place = order.place(heads, use.predicate)
        text = f"({use.predicate} {span.name} {slot})"
        beside = conjuncts[max(place - 1, 0)]
        where = "behind" if place else "in front of"
        edit = (
            insert(FORM, beside.end, f" {text}")
            if place
            else insert(FORM, beside.start, f"{text} ")
        )
        company = order.together(heads, use.predicate)
        yield f"Add {text} {where} {shorten(form.of(beside))}", edit, company / (company + 1)


def _add(form: FormText, use: _Use, slot: str) -> Iterator[tuple[str, TextEdit, float]]:
    """Yield label, edit and likelihood of one more argument behind those of an action."""
    for span in form.spans:
        is_same = span.kind == "application" and span.name == use.predicate
        if is_same and len(span.children) == use.place:
            at = span.children[-1].end if span.children else span.name_end
            yield f"Add {slot} to {use.predicate}", insert(FORM, at, f" {slot}"), 1.0
