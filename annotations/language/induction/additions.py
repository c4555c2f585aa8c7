"""What a proposal adds to a world, as values: productions, a task category, classes, entities, predicates."""

from __future__ import annotations

from collections.abc import Iterator

from annotations.language.forms import (
    HUES,
    EntityClass,
    EntityClasses,
    print_sequence,
)
from annotations.language.grammar import Grammar, read_production
from annotations.language.grounding import Anonymizer
from annotations.language.induction.classes import folded
from annotations.language.induction.lengthening import with_changes
from annotations.language.induction.marked_lines import Mark
from annotations.language.induction.proposal import CATEGORY, KnownWorld, Proposal
from annotations.language.induction.rules import phrase_symbols
from annotations.language.templates import TaskCategory, make_template
from annotations.language.texts import plural
from annotations.language.world import Entity, Ontology, Predicate

_HUES_APART = (
    137  # degrees: the golden angle, so that the colours of classes that follow each other differ
)


def new_productions(proposal: Proposal) -> Iterator[tuple[str, str]]:
    """Yield nonterminal and expansion: the words that vary, then each pattern as a command."""
    for each in proposal.synonyms:
        phrases = (print_sequence(phrase_symbols(phrase)) for phrase in each.phrases)
        yield each.name, " | ".join(phrases)
    for template in proposal.templates:
        yield "Main", template.pattern


def category_of(proposal: Proposal) -> TaskCategory:
    """Return the grammar and the templates that are proposed."""
    lines = (f"${name} = {expansion}" for name, expansion in new_productions(proposal))
    templates = (make_template(each.pattern, each.form) for each in proposal.templates)
    return TaskCategory(CATEGORY, Grammar(tuple(map(read_production, lines))), tuple(templates))


def categories_with(proposal: Proposal, known: KnownWorld) -> tuple[TaskCategory, ...]:
    """Return the task categories that are other ones, or new, once a proposal is stored."""
    stored = known.stored.categories if known.stored else ()
    changed = [with_changes(each, proposal.changes) for each in stored]
    names = [each.name for each in stored]
    if proposal.templates:
        new = category_of(proposal)
        if known.category in names:
            place = names.index(known.category)
            old = changed[place]
            productions = (*old.grammar.productions, *new.grammar.productions)
            templates = (*old.templates, *new.templates)
            changed[place] = TaskCategory(old.name, Grammar(productions), templates)
        else:
            changed.append(TaskCategory(known.category, new.grammar, new.templates))
    return tuple(each for each in changed if not any(each is old for old in stored))


def new_classes(proposal: Proposal, known: EntityClasses) -> tuple[EntityClass, ...]:
    """Return the classes that ``known`` lacks, each with a colour of its own."""
    tokens = (each.token for each in proposal.classes if each.token not in known)
    return tuple(
        EntityClass(token, words, plural(words), place * _HUES_APART % HUES, words)
        for place, token in enumerate(tokens, start=len(known))
        for words in (token.replace("_", " "),)
    )


def new_entities(proposal: Proposal, known: KnownWorld) -> tuple[Entity, ...]:
    """Return the entities that the world lacks."""
    return tuple(
        Entity(each.token, text, proposal.names.get(text, ()))
        for each in proposal.classes
        for text in each.texts
        if known.texts.get(folded(text)) != each.token
    )


def new_predicates(proposal: Proposal, known: KnownWorld) -> tuple[Predicate, ...]:
    """Return the predicates that the world lacks, and those that it has with new signatures."""
    found = (each.predicate for each in proposal.predicates)
    return tuple(each for each in found if known.predicates.get(each.name) != each)


def with_proposal(known: Ontology, proposal: Proposal, world: KnownWorld) -> Ontology:
    """Return the ontology of a world together with what is proposed."""
    classes = known.classes.with_rows(new_classes(proposal, known.classes))
    return Ontology((*known.entities, *new_entities(proposal, world)), classes)


def marked(said: str, ontology: Ontology, proposal: Proposal) -> str:
    """Return a command with marks around the entities that it names, as the line of an example."""
    unnamed = {each.token for each in proposal.classes if not each.is_named}
    anonymized = Anonymizer(ontology).anonymize(said)
    line, place = "", 0
    for span in anonymized.spans:
        name = anonymized.original[span.start : span.end]
        token = "" if span.entity_class in unnamed else span.entity_class
        line += f"{anonymized.original[place : span.start]}{Mark(name, token)}"
        place = span.end
    return line + anonymized.original[place:]
