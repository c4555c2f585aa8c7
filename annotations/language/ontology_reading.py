"""Ontology files (FORMATS §2) → rows and problems."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from annotations.language.decoding import decode
from annotations.language.entities import Entity, Ontology
from annotations.language.errors import LanguageError, Position, Problem, error, warning
from annotations.language.ontology_checks import ontology_problems
from annotations.language.xml_elements import Element, read_xml

ALIAS_SEPARATOR = ";"

Found = Iterator[Entity | Problem]


def read_ontology_folder(folder: Path) -> tuple[Ontology, tuple[Problem, ...]]:
    """Reads those of the ontology's files that the folder has; see ``read_ontology``."""
    files = {name: folder / name for name in ONTOLOGY_FILES if (folder / name).is_file()}
    return read_ontology({name: path.read_bytes() for name, path in files.items()})


def read_ontology(files: Mapping[str, bytes]) -> tuple[Ontology, tuple[Problem, ...]]:
    """Reads ontology files given as name → content; other names are not looked at.

    Returns:
        The rows, and every problem with its place: an error for a file that cannot be read, which
        then gives no rows, warnings for what is odd. Nothing is raised.
    """
    entities: list[Entity] = []
    problems: list[Problem] = []
    for name, reader in ONTOLOGY_FILES.items():
        if name in files:
            rows, found = _read(reader, files[name], name)
            entities += rows
            problems += found
    entities, found = _with_singulars(entities)
    ontology = Ontology(tuple(entities))
    return ontology, (*problems, *found, *ontology_problems(ontology))


def _read(
    reader: Callable[[str, str], Found], data: bytes, name: str
) -> tuple[list[Entity], list[Problem]]:
    try:
        found = list(reader(decode(data, name), name))
    except LanguageError as trouble:
        return [], [trouble.problem]
    entities = [each for each in found if isinstance(each, Entity)]
    return entities, [each for each in found if isinstance(each, Problem)]


def _objects(text: str, source: str) -> Found:
    root = read_xml(text, source, "categories")
    for category in _children(root, "category"):
        if isinstance(category, Problem):
            yield category
            continue
        yield from _named(category, "category")
        for item in _children(category, "object"):
            belongs = {"category": category.attributes.get("name", "")}
            yield from [item] if isinstance(item, Problem) else _named(item, "object", belongs)


def _locations(text: str, source: str) -> Found:
    root = read_xml(text, source, "rooms")
    for room in _children(root, "room"):
        if isinstance(room, Problem):
            yield room
            continue
        yield from _named(room, "room")
        for item in _children(room, "location"):
            belongs = {"room": room.attributes.get("name", "")}
            yield from [item] if isinstance(item, Problem) else _named(item, "location", belongs)


def _names(text: str, source: str) -> Found:
    for item in _children(read_xml(text, source, "names"), "name"):
        if isinstance(item, Problem):
            yield item
        elif not item.text:
            yield error(item.position, "this name is empty", "write it between the tags")
        else:
            yield _entity("name", item.text, item.attributes, item.position)


def _gestures(text: str, source: str) -> Found:
    for item in _children(read_xml(text, source, "gestures"), "gesture"):
        yield from [item] if isinstance(item, Problem) else _named(item, "gesture")


def _questions(text: str, source: str) -> Found:
    for item in _children(read_xml(text, source, "questions"), "question"):
        if isinstance(item, Problem):
            yield item
            continue
        asked = next((each.text for each in item.each("q") if each.text), "")
        answer = next((each.text for each in item.each("a")), "")
        if asked:
            attributes = {**item.attributes, "answer": answer}
            yield _entity("question", asked, attributes, item.position)
        else:
            yield error(item.position, "this question has no <q>", "write <q>…</q> in it")


def _categories(text: str, source: str) -> Found:
    """Rows that only carry a singular; ``_with_singulars`` gives it to the rows of objects.xml."""
    header, *lines = text.split("\n")
    columns = [cell.strip().lower() for cell in header.split(",")]
    if len(columns) != 2 or "plural" not in columns[0] or "singular" not in columns[1]:
        raise LanguageError(
            "the first line is not the header of a table of plurals and singulars",
            Position(source),
            "begin with: name plural, name singular",
        )
    for number, line in enumerate(lines, 2):
        cells = [" ".join(cell.split()) for cell in line.split(",")]
        place = Position(source, number)
        if cells == [""]:
            continue
        if len(cells) != 2 or not all(cells):
            yield error(place, "this line is not one plural and one singular", "drinks, drink")
        else:
            yield Entity("category", cells[0], (), {"singular": cells[1]}, place)


def _sayings(text: str, source: str) -> Found:
    if text.lstrip().startswith("<"):
        raise LanguageError("this is XML, not one saying a line", Position(source), "one a line")
    for number, line in enumerate(text.split("\n"), 1):
        if saying := " ".join(line.split()):
            yield Entity("whattosay", saying, position=Position(source, number))


# In this order rows are kept.
ONTOLOGY_FILES: dict[str, Callable[[str, str], Found]] = {
    "objects.xml": _objects,
    "locations.xml": _locations,
    "names.xml": _names,
    "gestures.xml": _gestures,
    "questions.xml": _questions,
    "whattosay.txt": _sayings,
    "categories.txt": _categories,
}


def _children(parent: Element, tag: str) -> Iterator[Element | Problem]:
    """The children that belong there, and a warning for each that does not."""
    for child in parent.children:
        if child.tag == tag:
            yield child
        else:
            message = f"<{child.tag}> is not known inside <{parent.tag}> and is left out"
            yield warning(child.position, message, f"only <{tag}> is read here")


def _named(element: Element, entity_class: str, belongs: Mapping[str, str] | None = None) -> Found:
    """The row of an element whose ``name`` attribute is its text."""
    attributes = {**element.attributes, **(belongs or {})}
    name = attributes.pop("name", "")
    if name:
        yield _entity(entity_class, name, attributes, element.position)
    else:
        yield error(element.position, f"this <{element.tag}> has no name", 'write name="…"')


def _entity(
    entity_class: str, text: str, attributes: Mapping[str, str], position: Position
) -> Entity:
    written = attributes.get("aliases", "").split(ALIAS_SEPARATOR)
    aliases = tuple(alias.strip() for alias in written if alias.strip())
    rest = {key: value for key, value in attributes.items() if key != "aliases"}
    return Entity(entity_class, text, aliases, rest, position)


def _with_singulars(entities: list[Entity]) -> tuple[list[Entity], list[Problem]]:
    """Merges the rows of categories.txt into the category rows of the same name."""
    declared = {each.text: each for each in entities if each.position.source == "categories.txt"}
    rows = [each for each in entities if each.position.source != "categories.txt"]
    known = {each.text for each in rows if each.entity_class == "category"}
    merged = [
        _with_singular(each, declared[each.text])
        if each.entity_class == "category" and each.text in declared
        else each
        for each in rows
    ]
    lonely = [each for name, each in declared.items() if name not in known]
    problems = [
        warning(
            each.position, f"no object is of the category {each.text}", "add one to objects.xml"
        )
        for each in lonely
    ]
    return merged + lonely, problems


def _with_singular(entity: Entity, declared: Entity) -> Entity:
    attributes = {**entity.attributes, **declared.attributes}
    return Entity(entity.entity_class, entity.text, entity.aliases, attributes, entity.position)
