"""Write an ontology to its files (FORMATS §2). Reading them back gives the same rows."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from xml.sax.saxutils import escape, quoteattr

from annotations.language.ontology.entities import Entity, Ontology
from annotations.language.ontology.reading import ALIAS_SEPARATOR

_DECLARATION = '<?xml version="1.0" encoding="utf-8"?>'


def write_ontology(ontology: Ontology) -> dict[str, str]:
    """Return file name → text, for every file that has a row."""
    files = {
        "objects.xml": _write_nested(ontology, "categories", "category", "object"),
        "locations.xml": _write_nested(ontology, "rooms", "room", "location"),
        "names.xml": _write_names(ontology.of_class("name")),
        "gestures.xml": _write_gestures(ontology.of_class("gesture")),
        "questions.xml": _write_questions(ontology.of_class("question")),
        "categories.txt": _write_categories(ontology),
        "whattosay.txt": _write_lines(each.text for each in ontology.of_class("whattosay")),
    }
    return {name: text for name, text in files.items() if text}


def _write_nested(ontology: Ontology, root: str, outer: str, inner: str) -> str:
    """Write two levels of rows; each inner row goes into the last outer row of its name before it."""
    parts: list[tuple[Entity, list[Entity]]] = []
    for entity in ontology.entities:
        if entity.entity_class == outer and not _is_bare(entity):
            parts.append((entity, []))
        elif entity.entity_class == inner:
            _find_part(parts, outer, entity)[1].append(entity)
    return _write_document(root, _write_blocks(parts, outer, inner)) if parts else ""


def _find_part(
    parts: list[tuple[Entity, list[Entity]]], outer: str, entity: Entity
) -> tuple[Entity, list[Entity]]:
    name = entity.attribute(outer) or ""
    for part in reversed(parts):
        if part[0].text == name:
            return part
    parts.append((Entity(outer, name), []))
    return parts[-1]


def _write_blocks(
    parts: Iterable[tuple[Entity, list[Entity]]], outer: str, inner: str
) -> Iterator[str]:
    for entity, inside in parts:
        yield f"    <{outer}{_write_attributes(entity, without=('singular',))}>"
        for each in inside:
            yield f"        <{inner}{_write_attributes(each, without=(outer,))}/>"
        yield f"    </{outer}>"


def _is_bare(entity: Entity) -> bool:
    """Return whether a category is only in categories.txt."""
    is_category = entity.entity_class == "category" and not entity.aliases
    return is_category and set(entity.attributes) == {"singular"}


def _write_names(entities: Iterable[Entity]) -> str:
    rows = [
        f"    <name{_write_attributes(each, is_named=False)}>{escape(each.text)}</name>"
        for each in entities
    ]
    return _write_document("names", rows) if rows else ""


def _write_gestures(entities: Iterable[Entity]) -> str:
    rows = [f"    <gesture{_write_attributes(each)}/>" for each in entities]
    return _write_document("gestures", rows) if rows else ""


def _write_questions(entities: Iterable[Entity]) -> str:
    rows = [
        f"    <question{_write_attributes(each, without=('answer',), is_named=False)}>\n"
        f"        <q>{escape(each.text)}</q>\n"
        f"        <a>{escape(each.attribute('answer') or '')}</a>\n"
        "    </question>"
        for each in entities
    ]
    return _write_document("questions", rows) if rows else ""


def _write_categories(ontology: Ontology) -> str:
    rows = [f"{plural}, {singular}" for plural, singular in ontology.singulars.items()]
    return _write_lines(["name plural, name singular", *rows]) if rows else ""


def _write_lines(lines: Iterable[str]) -> str:
    return "".join(f"{line}\n" for line in lines)


def _write_document(root: str, rows: Iterable[str]) -> str:
    return _write_lines([_DECLARATION, f"<{root}>", *rows, f"</{root}>"])


def _write_attributes(entity: Entity, without: tuple[str, ...] = (), is_named: bool = True) -> str:
    values = {key: value for key, value in entity.attributes.items() if key not in without}
    named = {"name": entity.text} if is_named else {}
    aliases = {"aliases": ALIAS_SEPARATOR.join(entity.aliases)} if entity.aliases else {}
    written = {**named, **values, **aliases}
    return "".join(f" {key}={quoteattr(value)}" for key, value in written.items())
