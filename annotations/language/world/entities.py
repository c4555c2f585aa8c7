"""The things that commands talk about, as frozen values. Import them from ``ontology``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

from annotations.language.forms import (
    DEFAULT_CLASSES,
    KIND_CLASS,
    EntityClasses,
)
from annotations.language.texts import Position


@dataclass(frozen=True, slots=True)
class Entity:
    """One row of an ontology.

    A text may occur in several rows: a name of both genders, a sink in two rooms, a category that
    is kept in two places. Positions play no part in equality. ``attributes`` are those of the file
    plus ``category`` of an object, ``room`` of a location, ``singular`` of a category and
    ``answer`` of a question.
    """

    entity_class: str
    text: str
    aliases: tuple[str, ...] = ()
    attributes: Mapping[str, str] = field(default_factory=dict, hash=False)
    position: Position = field(default_factory=Position, compare=False)

    def attribute(self, name: str) -> str | None:
        """Return the value of an attribute, ignoring the case of its name; ``name`` is the text itself."""
        wanted = name.lower()
        if wanted == "name":
            return self.text
        values = (value for key, value in self.attributes.items() if key.lower() == wanted)
        return next(values, None)

    def is_set(self, name: str) -> bool:
        """Return whether an attribute is present and true."""
        return (self.attribute(name) or "").lower() == "true"


@dataclass(frozen=True)
class Ontology:
    """Rows in the order of their files, and the classes that they may be of."""

    entities: tuple[Entity, ...] = ()
    classes: EntityClasses = DEFAULT_CLASSES

    @cached_property
    def by_class(self) -> Mapping[str, tuple[Entity, ...]]:
        """The rows of each entity class that has any."""
        classes = dict.fromkeys(entity.entity_class for entity in self.entities)
        return {
            name: tuple(each for each in self.entities if each.entity_class == name)
            for name in classes
        }

    def of_class(self, entity_class: str) -> tuple[Entity, ...]:
        """Return the rows of a class; none if the ontology does not have the class."""
        return self.by_class.get(entity_class, ())

    def texts_of(self, entity_class: str) -> tuple[str, ...]:
        """Return the different texts of the rows of a class, in order."""
        return self._texts.get(entity_class, ())

    @cached_property
    def _texts(self) -> Mapping[str, tuple[str, ...]]:
        return {
            name: tuple(dict.fromkeys(each.text for each in rows))
            for name, rows in self.by_class.items()
        }

    @cached_property
    def class_of_text(self) -> Mapping[str, str]:
        """Text → its class, for the texts that are of one class alone."""
        classes: dict[str, set[str]] = {}
        for each in self.entities:
            classes.setdefault(each.text, set()).add(each.entity_class)
        return {text: next(iter(names)) for text, names in classes.items() if len(names) == 1}

    @cached_property
    def singulars(self) -> Mapping[str, str]:
        """Category name → its singular, for the categories that declare one."""
        pairs = ((each.text, each.attribute("singular")) for each in self.of_class(KIND_CLASS))
        return {name: singular for name, singular in pairs if singular}

    def singular(self, category: str) -> str:
        """Return the singular of a category's name: ``drink`` for ``drinks``; the name itself by default."""
        return self.singulars.get(category, category)
