"""Edits after which the form must change in a known way, or, with class tokens, not at all."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from random import Random

from annotations.language.forms import Constant, Form, equivalent, head_predicate, size
from annotations.language.templates import solve_analogy
from annotations.language.texts import RECIPIENT_PRONOUNS
from annotations.language.world import Entity, find_misuses
from parser_service.analysis.edit import EditKind, UtteranceEdit, substitute
from parser_service.analysis.facts import WorldFacts
from parser_service.analysis.mentions import (
    TokenizedUtterance,
    UtteranceToken,
    constant_of,
    is_named,
)

# Classes that may be exchanged, and what such an edit is called.
_EXCHANGES = {
    ("room", "location"): EditKind.PLACE,
    ("location", "room"): EditKind.PLACE,
    ("object", "category"): EditKind.CLASS,
    ("category", "object"): EditKind.CLASS,
}


def exchange_entity(
    utterance: TokenizedUtterance, form: Form, facts: WorldFacts, random: Random
) -> Iterator[UtteranceEdit]:
    """Name another entity of the same class; a form with class tokens stays as it is."""
    for mention in utterance.mentions:
        # A noun fits where another one fits; a question or a saying does not.
        known = facts.ontology.classes.get(mention.entity_class)
        if not mention.is_exact or known is None or known.is_closed:
            continue
        entity = _another(mention.entity_class, utterance, facts, random)
        if entity is None:
            continue
        changed: Form | None = form
        if is_named(mention, form):
            constant = constant_of(mention, utterance, form)
            changed = constant and substitute(form, constant, Constant(entity.text))
        if changed is not None:
            text = utterance.replace(mention, entity.text)
            yield UtteranceEdit(EditKind.ENTITY, text, changed, mention.text, entity.text)


def exchange_class(
    utterance: TokenizedUtterance, form: Form, facts: WorldFacts, random: Random
) -> Iterator[UtteranceEdit]:
    """Name a location instead of a room, a category instead of an object, or the other way round.

    Only where it is certain which constant of the form is meant. The grammar decides what the form becomes
    where it has such a pair; elsewhere the constant alone changes.
    """
    for (old_class, new_class), kind in _EXCHANGES.items():
        for mention in utterance.of_class(old_class):
            constant = constant_of(mention, utterance, form)
            if constant is None or (mention.value and not mention.is_exact):
                continue
            new = _say(new_class, mention, utterance, facts, random)
            if not new:
                continue
            is_entity = is_named(mention, form)
            value = Constant(new if is_entity else f"<{new_class}>")
            words = (f"<{old_class}>", f"<{new_class}>")
            by_grammar = [] if is_entity else _by_contrast(form, words, facts)
            changed = _only(by_grammar or [substitute(form, constant, value)])
            if changed is not None and _is_well_typed(changed, facts):
                yield UtteranceEdit(
                    kind, utterance.replace(mention, new), changed, mention.text, new
                )


def exchange_recipient(
    utterance: TokenizedUtterance, form: Form, facts: WorldFacts, random: Random
) -> Iterator[UtteranceEdit]:
    """Put a name in place of “me”, or “me” in place of a name, where the grammar has such a pair.

    Nothing is made of a form that names entities itself: the grammar's forms have class tokens.
    """
    if any(is_named(each, form) for each in utterance.mentions):
        return
    words = [each.text.lower() for each in utterance.mentions]
    for place, mention in enumerate(utterance.mentions):
        if words[place] in RECIPIENT_PRONOUNS and words.count(words[place]) == 1:
            name = _say("name", mention, utterance, facts, random)
            pair, new = (words[place], "<name>"), name
        elif mention.entity_class == "name" and "to" in words[max(0, place - 1) : place]:
            pair, new = ("<name>", "me"), "me"
        else:
            continue
        changed = _only(_by_contrast(form, pair, facts))
        if new and changed is not None and _is_well_typed(changed, facts):
            text = utterance.replace(mention, new)
            yield UtteranceEdit(EditKind.RECIPIENT, text, changed, mention.text, new)


def _say(
    entity_class: str,
    mention: UtteranceToken,
    utterance: TokenizedUtterance,
    facts: WorldFacts,
    random: Random,
) -> str:
    """Return a class token where the utterance has such tokens, else the text of an entity; empty if none."""
    has_tokens = any(each.entity_class and not each.value for each in utterance.mentions)
    if has_tokens or (mention.entity_class and not mention.value):
        return f"<{entity_class}>"
    entity = _another(entity_class, utterance, facts, random)
    return entity.text if entity is not None else ""


def _another(
    entity_class: str, utterance: TokenizedUtterance, facts: WorldFacts, random: Random
) -> Entity | None:
    """Return an entity of the class that the utterance does not name; None if there is none."""
    named = {each.value.casefold() for each in utterance.mentions}
    others = [
        entity
        for entity in facts.ontology.of_class(entity_class)
        if entity.text.casefold() not in named
    ]
    return random.choice(others) if others else None


def _by_contrast(form: Form, words: tuple[str, str], facts: WorldFacts) -> list[Form]:
    """Return what the known pairs with such a change of words make of the form, without repetitions."""
    solutions: list[Form] = []
    for first, second in facts.contrasts.get(words, ()):
        if head_predicate(first) != head_predicate(form):
            continue
        solved = solve_analogy(first, second, form)
        # An analogy may drop what the model form does not have; then more changes than should.
        if solved is None or size(solved) - size(form) != size(second) - size(first):
            continue
        if not any(equivalent(solved, each) for each in solutions):
            solutions.append(solved)
    return solutions


def _only(forms: Sequence[Form]) -> Form | None:
    """Return the form on which all agree; None where they do not, or there is none."""
    return forms[0] if len(forms) == 1 else None


def _is_well_typed(form: Form, facts: WorldFacts) -> bool:
    return not facts.predicates or not any(find_misuses(form, facts.predicates))
