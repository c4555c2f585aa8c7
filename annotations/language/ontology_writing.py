"""An ontology → its files (FORMATS §2). Reading them again gives the same rows."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from xml.sax.saxutils import escape, quoteattr

from annotations.language.entities import Entity, Ontology
from annotations.language.ontology_reading import ALIAS_SEPARATOR

_DECLARATION = '<?xml version="1.0" encoding="utf-8"?>'


def write_ontology(ontology: Ontology) -> dict[str, str]:
    """File name → text, for every file that has a row."""
    files = {
        "objects.xml": _nested(ontology, "categories", "category", "object"),
        "locations.xml": _nested(ontology, "rooms", "room", "location"),
        "names.xml": _names(ontology.of_class("name")),
        "gestures.xml": _gestures(ontology.of_class("gesture")),
        "questions.xml": _questions(ontology.of_class("question")),
        "categories.txt": _categories(ontology),
        "whattosay.txt": _lines(each.text for each in ontology.of_class("whattosay")),
    }
    return {name: text for name, text in files.items() if text}


def _nested(ontology: Ontology, root: str, outer: str, inner: str) -> str:
    """Each inner row goes into the last outer row of its name before it."""
    parts: list[tuple[Entity, list[Entity]]] = []
    for entity in ontology.entities:
        if entity.entity_class == outer and not _is_bare(entity):
            parts.append((entity, []))
        elif entity.entity_class == inner:
            _part(parts, outer, entity)[1].append(entity)
    return _document(root, _blocks(parts, outer, inner)) if parts else ""


def _part(
    parts: list[tuple[Entity, list[Entity]]], outer: str, entity: Entity
) -> tuple[Entity, list[Entity]]:
    name = entity.attribute(outer) or ""
    for part in reversed(parts):
        if part[0].text == name:
            return part
    parts.append((Entity(outer, name), []))
    return parts[-1]


def _blocks(parts: Iterable[tuple[Entity, list[Entity]]], outer: str, inner: str) -> Iterator[str]:
    for entity, inside in parts:
        yield f"    <{outer}{_attributes(entity, without=('singular',))}>"
        for each in inside:
            yield f"        <{inner}{_attributes(each, without=(outer,))}/>"
        yield f"    </{outer}>"


def _is_bare(entity: Entity) -> bool:
    """A category that only categories.txt knows."""
    is_category = entity.entity_class == "category" and not entity.aliases
    return is_category and set(entity.attributes) == {"singular"}


def _names(entities: Iterable[Entity]) -> str:
    rows = [
        f"    <name{_attributes(each, is_named=False)}>{escape(each.text)}</name>"
        for each in entities
    ]
    return _document("names", rows) if rows else ""


def _gestures(entities: Iterable[Entity]) -> str:
    rows = [f"    <gesture{_attributes(each)}/>" for each in entities]
    return _document("gestures", rows) if rows else ""


def _questions(entities: Iterable[Entity]) -> str:
    rows = [
        f"    <question{_attributes(each, without=('answer',), is_named=False)}>\n"
        f"        <q>{escape(each.text)}</q>\n"
        f"        <a>{escape(each.attribute('answer') or '')}</a>\n"
        "    </question>"
        for each in entities
    ]
    return _document("questions", rows) if rows else ""


def _categories(ontology: Ontology) -> str:
    rows = [f"{plural}, {singular}" for plural, singular in ontology.singulars.items()]
    return _lines(["name plural, name singular", *rows]) if rows else ""


def _lines(lines: Iterable[str]) -> str:
    return "".join(f"{line}\n" for line in lines)


def _document(root: str, rows: Iterable[str]) -> str:
    return _lines([_DECLARATION, f"<{root}>", *rows, f"</{root}>"])


def _attributes(entity: Entity, without: tuple[str, ...] = (), is_named: bool = True) -> str:
    values = {key: value for key, value in entity.attributes.items() if key not in without}
    named = {"name": entity.text} if is_named else {}
    aliases = {"aliases": ALIAS_SEPARATOR.join(entity.aliases)} if entity.aliases else {}
    written = {**named, **values, **aliases}
    return "".join(f" {key}={quoteattr(value)}" for key, value in written.items())
