"""Read ontology files (FORMATS §2) into rows and problems."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial

from annotations.language.decoding import decode
from annotations.language.errors import LanguageError, Position, Problem, error_at, warning_at
from annotations.language.ontology.checks import ontology_problems
from annotations.language.ontology.entities import Entity, Ontology
from annotations.language.ontology.xml_elements import Element, read_xml

ALIAS_SEPARATOR = ";"

Found = Iterator[Entity | Problem]


def read_ontology(files: Mapping[str, bytes]) -> tuple[Ontology, tuple[Problem, ...]]:
    """Read ontology files given as name → content; other names are ignored.

    Returns:
        The rows, and every problem with its place: an error for a file that cannot be read, which
        then gives no rows, and a warning for anything odd. Nothing is raised.
    """
    entities: list[Entity] = []
    problems: list[Problem] = []
    for name, reader in _READERS.items():
        if name in files:
            rows, unread = _read(reader, files[name], name)
            entities += rows
            problems += unread
    entities, lonely = _add_singulars(entities)
    ontology = Ontology(tuple(entities))
    return ontology, (*problems, *lonely, *ontology_problems(ontology))


def _read(
    reader: Callable[[str, str], Found], data: bytes, name: str
) -> tuple[list[Entity], list[Problem]]:
    try:
        results = list(reader(decode(data, name), name))
    except LanguageError as error:
        return [], [error.problem]
    entities = [each for each in results if isinstance(each, Entity)]
    return entities, [each for each in results if isinstance(each, Problem)]


def _read_nested(text: str, source: str, root: str, outer: str, inner: str) -> Found:
    """Yield the rows of the ``outer`` elements below ``root``, and those of the ``inner`` ones within, which
    have the name of the outer one as an attribute."""
    for holder in _children(read_xml(text, source, root), outer):
        if isinstance(holder, Problem):
            yield holder
            continue
        yield from _read_named(holder, outer)
        belongs = {outer: holder.attributes.get("name", "")}
        for item in _children(holder, inner):
            yield from [item] if isinstance(item, Problem) else _read_named(item, inner, belongs)


def _read_names(text: str, source: str) -> Found:
    for item in _children(read_xml(text, source, "names"), "name"):
        if isinstance(item, Problem):
            yield item
        elif not item.text:
            yield error_at(item.position, "this name is empty", "write it between the tags")
        else:
            yield _entity("name", item.text, item.attributes, item.position)


def _read_gestures(text: str, source: str) -> Found:
    for item in _children(read_xml(text, source, "gestures"), "gesture"):
        yield from [item] if isinstance(item, Problem) else _read_named(item, "gesture")


def _read_questions(text: str, source: str) -> Found:
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
            yield error_at(item.position, "this question has no <q>", "add <q>…</q> to it")


def _read_categories(text: str, source: str) -> Found:
    """Yield rows with only a singular; ``_add_singulars`` gives it to the rows of objects.xml."""
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
            yield error_at(
                place, "this line is not one plural and one singular", "like: drinks, drink"
            )
        else:
            yield Entity("category", cells[0], (), {"singular": cells[1]}, place)


def _read_sayings(text: str, source: str) -> Found:
    if text.lstrip().startswith("<"):
        raise LanguageError(
            "this is XML, not one sentence per line", Position(source), "use plain text"
        )
    for number, line in enumerate(text.split("\n"), 1):
        if saying := " ".join(line.split()):
            yield Entity("whattosay", saying, position=Position(source, number))


# Rows are kept in this order.
_READERS: dict[str, Callable[[str, str], Found]] = {
    "objects.xml": partial(_read_nested, root="categories", outer="category", inner="object"),
    "locations.xml": partial(_read_nested, root="rooms", outer="room", inner="location"),
    "names.xml": _read_names,
    "gestures.xml": _read_gestures,
    "questions.xml": _read_questions,
    "whattosay.txt": _read_sayings,
    "categories.txt": _read_categories,
}

ONTOLOGY_FILES = tuple(_READERS)


def _children(parent: Element, tag: str) -> Iterator[Element | Problem]:
    """Yield the children with this tag, and a warning for each other child."""
    for child in parent.children:
        if child.tag == tag:
            yield child
        else:
            message = f"<{child.tag}> is not known inside <{parent.tag}> and is ignored"
            yield warning_at(child.position, message, f"only <{tag}> is read here")


def _read_named(
    element: Element, entity_class: str, belongs: Mapping[str, str] | None = None
) -> Found:
    """Yield the row of an element whose ``name`` attribute is its text."""
    attributes = {**element.attributes, **(belongs or {})}
    name = attributes.pop("name", "")
    if name:
        yield _entity(entity_class, name, attributes, element.position)
    else:
        yield error_at(element.position, f"this <{element.tag}> has no name", 'write name="…"')


def _entity(
    entity_class: str, text: str, attributes: Mapping[str, str], position: Position
) -> Entity:
    written = attributes.get("aliases", "").split(ALIAS_SEPARATOR)
    aliases = tuple(alias.strip() for alias in written if alias.strip())
    rest = {key: value for key, value in attributes.items() if key != "aliases"}
    return Entity(entity_class, text, aliases, rest, position)


def _add_singulars(entities: list[Entity]) -> tuple[list[Entity], list[Problem]]:
    """Merge the rows of categories.txt into the category rows of the same name."""
    declared = {each.text: each for each in entities if each.position.source == "categories.txt"}
    rows = [each for each in entities if each.position.source != "categories.txt"]
    known = {each.text for each in rows if each.entity_class == "category"}
    merged = [
        _add_singular(each, declared[each.text])
        if each.entity_class == "category" and each.text in declared
        else each
        for each in rows
    ]
    lonely = [each for name, each in declared.items() if name not in known]
    problems = [
        warning_at(
            each.position, f"no object is of the category {each.text}", "add one to objects.xml"
        )
        for each in lonely
    ]
    return merged + lonely, problems


def _add_singular(entity: Entity, declared: Entity) -> Entity:
    attributes = {**entity.attributes, **declared.attributes}
    return Entity(entity.entity_class, entity.text, entity.aliases, attributes, entity.position)
