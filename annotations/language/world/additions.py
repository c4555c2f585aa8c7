"""Read entities that somebody pastes, and say what is wrong with adding them to an ontology."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from annotations.language.forms import ATTRIBUTES, PERSON_CLASS, PLACE_CLASS
from annotations.language.texts import Position, Problem, warning_at
from annotations.language.world.entities import Entity, Ontology
from annotations.language.world.ontology_checks import ontology_problems

SOURCE = "entities"  # of the positions of what is read here


@dataclass(frozen=True, slots=True)
class Additions:
    """``new`` are to be added; ``duplicates`` are there already, or come twice. Positions are lines."""

    new: tuple[Entity, ...]
    duplicates: tuple[Entity, ...]
    problems: tuple[Problem, ...]

    @property
    def has_errors(self) -> bool:
        return any(problem.is_error for problem in self.problems)


def read_entities(
    text: str, entity_class: str, attributes: Mapping[str, str]
) -> tuple[Entity, ...]:
    """Read ``text | alias, alias``, one a line; all get the class and the attributes."""
    entities: list[Entity] = []
    for number, line in enumerate(text.splitlines(), start=1):
        name, _, aliases = line.partition("|")
        if line.strip():
            spellings = (" ".join(alias.split()) for alias in aliases.split(","))
            entity = Entity(
                entity_class,
                " ".join(name.split()),
                tuple(dict.fromkeys(filter(None, spellings))),
                dict(attributes),
                Position(SOURCE, number),
            )
            entities.append(entity)
    return tuple(entities)


def additions_to(ontology: Ontology, entities: Iterable[Entity]) -> Additions:
    """Return which of ``entities`` are new, and the problems that they would add to ``ontology``."""
    known = {_key(entity) for entity in ontology.entities}
    new: list[Entity] = []
    duplicates: list[Entity] = []
    for entity in entities:
        (duplicates if _key(entity) in known else new).append(entity)
        known.add(_key(entity))
    before = {(each.position, each.message) for each in ontology_problems(ontology)}
    after = ontology_problems(replace(ontology, entities=(*ontology.entities, *new)))
    problems = {each for each in after if (each.position, each.message) not in before}
    owner: dict[tuple[str, str], str] = {}  # class and name → the entity that has the name first
    for entity in ontology.entities:
        for name in (entity.text, *entity.aliases):
            owner.setdefault((entity.entity_class, name.casefold()), entity.text)
    for entity in new:
        for name in (entity.text, *entity.aliases):
            other = owner.setdefault((entity.entity_class, name.casefold()), entity.text)
            if other.casefold() != entity.text.casefold():
                message = f"{other} is called {name} too"
                problems.add(warning_at(entity.position, message, "use a name of its own"))
    return Additions(tuple(new), tuple(duplicates), tuple(sorted(problems)))


def _key(entity: Entity) -> tuple[str, str, str]:
    """Return what may not be there twice: a place once in a room, a name once for each gender."""
    is_told_apart = entity.entity_class in (PLACE_CLASS, PERSON_CLASS)
    beside = ATTRIBUTES[entity.entity_class] if is_told_apart else ""
    return entity.entity_class, entity.text.casefold(), (entity.attribute(beside) or "").casefold()
