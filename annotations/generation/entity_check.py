"""Check what grammar and templates ask for that no entity of the world is."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from annotations.language.forms import (
    Application,
    Constant,
    Wildcard,
    print_wildcard,
    walk,
    walk_symbols,
)
from annotations.language.grounding import may_fill
from annotations.language.plans import Lookup
from annotations.language.templates import SemanticTemplate, TaskCategory
from annotations.language.texts import Position, Problem, say_count, warning_at
from annotations.language.world import Ontology, Predicate


def entity_problems(
    categories: Iterable[TaskCategory], ontology: Ontology, predicates: Mapping[str, Predicate]
) -> Iterator[Problem]:
    """Yield a warning for each wildcard that no entity fits, and for each text of a form that should be one.

    Each stands at the first line that asks for it. A condition that names another wildcard is taken to hold.
    """
    categories = list(categories)
    for wildcard, places in _wildcards(categories).items():
        if not any(
            may_fill(entity, wildcard) for entity in ontology.of_class(wildcard.entity_class)
        ):
            written = print_wildcard(wildcard)
            said = f"the world has no entity for {written}{_in_others(places)}"
            hint = f"add such an entity of the class {wildcard.entity_class}, or change the lines"
            yield warning_at(min(places), said, hint)
    constants = _constants(categories)
    lookup = Lookup(ontology, predicates) if constants else None
    missing: dict[str, set[Position]] = defaultdict(set)
    for (text, predicate, place), places in constants.items():
        if lookup is None or not lookup.value(text, predicate, place)[1]:
            continue
        # Of several places that a word can mean the plan asks for one.
        if not lookup.places_called(text):
            missing[text] |= places
    for text, places in missing.items():
        said = f"“{text}” of the form is no entity of the world{_in_others(places)}"
        yield warning_at(min(places), said, "add it to the ontology, or change the template")


def _wildcards(categories: Iterable[TaskCategory]) -> dict[Wildcard, set[Position]]:
    """Return each kind of wildcard that stands for an entity, without number and note, and where it stands."""
    places: dict[Wildcard, set[Position]] = defaultdict(set)
    for category in categories:
        lines = [(each.expansion, each.position) for each in category.grammar.productions]
        lines += [(each.pattern, each.position) for each in category.templates]
        for symbols, position in lines:
            for symbol in walk_symbols(symbols, notes=True):
                if isinstance(symbol, Wildcard) and symbol.entity_class:
                    kind = replace(symbol, id=None, obfuscated=False, meta=())
                    places[kind].add(position)
    return places


def _constants(
    categories: Iterable[TaskCategory],
) -> dict[tuple[str, str, int], set[Position]]:
    """Return each text that a form quotes, with its predicate and its place there, and where it stands."""
    places: dict[tuple[str, str, int], set[Position]] = defaultdict(set)
    for category in categories:
        for template in category.templates:
            for key in _constants_of(template):
                places[key].add(template.position)
    return places


def _constants_of(template: SemanticTemplate) -> Iterator[tuple[str, str, int]]:
    for node in walk(template.form):
        if not isinstance(node, Application) or not isinstance(node.predicate, str):
            continue
        for place, argument in enumerate(node.arguments):
            if isinstance(argument, Constant) and not argument.token_class:
                yield str(argument.value), node.predicate, place


def _in_others(places: set[Position]) -> str:
    return f" (here and in {say_count(len(places) - 1, 'other line')})" if len(places) > 1 else ""
