"""Read and write the files of an ontology (docs/reference/formats.md, Ontology files).

What is written reads back as the same rows.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from io import BytesIO
from xml.sax import SAXParseException
from xml.sax.handler import ContentHandler
from xml.sax.saxutils import escape, quoteattr
from xml.sax.xmlreader import AttributesImpl, InputSource, XMLReader

from defusedxml import DefusedXmlException
from defusedxml.sax import make_parser

from annotations.language.forms import (
    DEFAULT_CLASSES,
    HUES,
    MAX_CLASS_WORDS,
    MAX_TOKEN,
    EntityClass,
    EntityClasses,
    require_token,
)
from annotations.language.texts import (
    MAX_NESTING,
    EmptyFile,
    LanguageError,
    Position,
    Problem,
    error_at,
    normalise_line,
    read_text,
    require_length,
    warning_at,
)
from annotations.language.world.entities import Entity, Ontology
from annotations.language.world.ontology_checks import ontology_problems

ALIAS_SEPARATOR = ";"

Found = Iterator[Entity | EntityClass | Problem]
_DECLARATION = '<?xml version="1.0" encoding="utf-8"?>'


def read_ontology(
    files: Mapping[str, bytes], known: EntityClasses = DEFAULT_CLASSES
) -> tuple[Ontology, tuple[Problem, ...]]:
    """Read ontology files given as name → content; other names are ignored, and so is the case of letters.

    Args:
        known: the classes that entities may be of, beside those that the files declare.

    Returns:
        The rows, and every problem with its place: an error for a file that cannot be read, which
        then gives no rows, and a warning for anything odd. Nothing is raised.
    """
    entities: list[Entity] = []
    problems: list[Problem] = []
    classes = known
    for known_name, reader in _READERS.items():
        names = sorted(name for name in files if name.lower() == known_name)
        for name in names[:1]:
            results, unread = _read(reader, files[name], name)
            rows = [each for each in results if isinstance(each, Entity)]
            classes = classes.with_rows(each for each in results if isinstance(each, EntityClass))
            if known_name == ENTITIES_FILE:
                unread += _of_no_class(rows, classes)
            entities += rows
            problems += unread
        for name in names[1:]:
            sentence = f"{names[0]} has the same name but for the case of its letters"
            problems.append(error_at(Position(name), sentence, "keep one of the two"))
    entities, lonely = _add_singulars(entities)
    ontology = Ontology(tuple(entities), classes)
    return ontology, (*problems, *lonely, *ontology_problems(ontology))


def _read(
    reader: Callable[[str, str], Found], data: bytes, name: str
) -> tuple[list[Entity | EntityClass], list[Problem]]:
    try:
        text, changes = read_text(data, name)
        results = list(reader(text, name))
    except EmptyFile as error:
        is_harmless = name.lower().endswith(".txt")
        warning = warning_at(error.position, error.message, error.hint)
        return [], [warning if is_harmless else error.problem]
    except LanguageError as error:
        return [], [error.problem]
    rows = [each for each in results if not isinstance(each, Problem)]
    return rows, [*changes, *(each for each in results if isinstance(each, Problem))]


def _read_nested(text: str, source: str, root: str, outer: str, inner: str) -> Found:
    """Yield the rows of the ``outer`` elements below ``root``, and those of the ``inner`` ones within, which
    have the name of the outer one as an attribute; ``inner`` ones beside them have none."""
    for holder in _children(read_xml(text, source, root), outer, inner):
        if isinstance(holder, Problem):
            yield holder
            continue
        if holder.tag == inner:
            yield from _read_named(holder, inner)
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


def _read_classes(text: str, source: str) -> Found:
    seen: set[str] = set()
    for item in _children(read_xml(text, source, "classes"), "class"):
        if isinstance(item, Problem):
            yield item
            continue
        try:
            read = _read_class(item)
        except LanguageError as error:
            yield error_at(item.position, error.message, error.hint)
            continue
        if read.token in seen:
            yield error_at(item.position, f"the class {read.token} is declared twice", "merge them")
        seen.add(read.token)
        yield read


def _read_class(item: Element) -> EntityClass:
    """Read ``<class token="pose" singular="pose" plural="poses" hue="20" said="pose" closed="true"/>``.

    Words that are left out are those of the token.
    """
    token = item.attributes.get("token", "")
    require_token(token)
    words = token.replace("_", " ")
    hue = item.attributes.get("hue", "0")
    if not (hue.isascii() and hue.isdecimal() and len(hue) < 4 and int(hue) < HUES):
        raise LanguageError(f"the hue of {token} is no number from 0 to {HUES - 1}", hint="like 40")
    said = {name: item.attributes.get(name) or words for name in ("singular", "plural", "said")}
    for name, text in said.items():
        require_length(text, f"{name} of {token}", MAX_CLASS_WORDS, item.position)
    is_closed = item.attributes.get("closed", "").lower() == "true"
    return EntityClass(token, hue=int(hue), is_closed=is_closed, **said)


def _read_entities(text: str, source: str) -> Found:
    """Yield the entities of classes without a file of their own: ``<pose name="sitting"/>``."""
    for item in read_xml(text, source, "entities").children:
        yield from _read_named(item, item.tag)


def _of_no_class(rows: Iterable[Entity], classes: EntityClasses) -> Iterator[Problem]:
    for each in rows:
        if each.entity_class not in classes:
            yield error_at(
                each.position,
                f"there is no class {each.entity_class[:MAX_TOKEN]}",
                f"declare it in {CLASSES_FILE}; there are {', '.join(classes.tokens)}",
            )


CLASSES_FILE, ENTITIES_FILE = "classes.xml", "entities.xml"

# Rows are kept in this order.
_READERS: dict[str, Callable[[str, str], Found]] = {
    CLASSES_FILE: _read_classes,
    "objects.xml": partial(_read_nested, root="categories", outer="category", inner="object"),
    "locations.xml": partial(_read_nested, root="rooms", outer="room", inner="location"),
    "names.xml": _read_names,
    "gestures.xml": _read_gestures,
    "questions.xml": _read_questions,
    "whattosay.txt": _read_sayings,
    "categories.txt": _read_categories,
    ENTITIES_FILE: _read_entities,
}

ONTOLOGY_FILES = tuple(_READERS)


def _children(parent: Element, *tags: str) -> Iterator[Element | Problem]:
    """Yield the children with these tags, and a warning for each other child."""
    for child in parent.children:
        if child.tag in tags:
            yield child
        else:
            message = f"<{child.tag}> is not known inside <{parent.tag}> and is ignored"
            known = " and ".join(f"<{tag}>" for tag in tags)
            yield warning_at(child.position, message, f"only {known} is read here")


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
    declared = {each.text: each for each in entities if _is_of_categories_txt(each)}
    rows = [each for each in entities if not _is_of_categories_txt(each)]
    known = {each.text for each in rows if each.entity_class == "category"}
    merged = [
        replace(each, attributes={**each.attributes, **declared[each.text].attributes})
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


def _is_of_categories_txt(entity: Entity) -> bool:
    return entity.position.source.lower() == "categories.txt"


@dataclass(slots=True)
class Element:
    """One element: its attributes (values with single spaces), text and children."""

    tag: str
    position: Position
    attributes: dict[str, str] = field(default_factory=dict)
    children: list[Element] = field(default_factory=list)
    text: str = ""

    def each(self, tag: str) -> Iterator[Element]:
        """Return the children with a tag, in order."""
        return (child for child in self.children if child.tag == tag)


def read_xml(text: str, source: str, root: str) -> Element:
    """Read a document whose outermost element is ``root``.

    Raises:
        LanguageError: not well-formed, another root, more than 64 levels, or a document type that
            declares entities or refers to other files.
    """
    handler = _Handler(source)
    reader: XMLReader = make_parser()
    reader.setContentHandler(handler)
    document = InputSource(source)
    document.setEncoding("utf-8")
    document.setByteStream(BytesIO(text.encode("utf-8")))
    try:
        reader.parse(document)
    except SAXParseException as error:
        line, column = error.getLineNumber() or 1, error.getColumnNumber() or 0
        place = Position(source, line, column + 1)
        raise LanguageError(
            f"this is not well-formed XML: {error.getMessage()}", place, "fix the markup here"
        ) from None
    except DefusedXmlException:
        raise LanguageError(
            "the document declares entities or refers to another file, which is not allowed",
            handler.position,
            "remove the <!DOCTYPE …> and write the text out",
        ) from None
    if handler.root.tag != root:
        raise LanguageError(
            f"the outermost element is <{handler.root.tag}>, not <{root}>",
            handler.root.position,
            f"this is not the kind of file that {source} should be",
        )
    return handler.root


class _Handler(ContentHandler):
    """Collects elements; the parser's locator says where each one is."""

    def __init__(self, source: str) -> None:
        super().__init__()
        self._source = source
        self._open: list[Element] = []
        self._pieces: list[list[str]] = []  # of the text of each open element
        self.root = Element("", Position(source))

    @property
    def position(self) -> Position:
        locator = self._locator  # type: ignore[attr-defined]
        line, column = locator.getLineNumber() or 1, locator.getColumnNumber() or 0
        return Position(self._source, line, column + 1)

    def startElement(self, name: str, attrs: AttributesImpl) -> None:
        values = {key: normalise_line(value) for key, value in attrs.items()}
        element = Element(name, self.position, values)
        if len(self._open) >= MAX_NESTING:
            raise LanguageError(
                f"elements nest more than {MAX_NESTING} deep", self.position, "close them earlier"
            )
        if self._open:
            self._open[-1].children.append(element)
        else:
            self.root = element
        self._open.append(element)
        self._pieces.append([])

    def endElement(self, name: str) -> None:
        element = self._open.pop()
        element.text = normalise_line("".join(self._pieces.pop()))

    def characters(self, content: str) -> None:
        self._pieces[-1].append(content)


def write_ontology(ontology: Ontology) -> dict[str, str]:
    """Return file name → text, for every file that has a row. Classes as a new world has them need no row."""
    names = [
        f"    <name{_write_attributes(each, is_named=False)}>{escape(each.text)}</name>"
        for each in ontology.of_class("name")
    ]
    gestures = [f"    <gesture{_write_attributes(each)}/>" for each in ontology.of_class("gesture")]
    questions = [
        f"    <question{_write_attributes(each, without=('answer',), is_named=False)}>\n"
        f"        <q>{escape(each.text)}</q>\n"
        f"        <a>{escape(each.attribute('answer') or '')}</a>\n"
        "    </question>"
        for each in ontology.of_class("question")
    ]
    singulars = [f"{plural}, {singular}" for plural, singular in ontology.singulars.items()]
    head = ["name plural, name singular"] if singulars else []
    changed = [each for each in ontology.classes if each != DEFAULT_CLASSES.get(each.token)]
    own = [each for each in ontology.entities if each.entity_class not in DEFAULT_CLASSES]
    files = {
        CLASSES_FILE: _write_document("classes", map(_write_class, changed)),
        "objects.xml": _write_nested(ontology, "categories", "category", "object"),
        "locations.xml": _write_nested(ontology, "rooms", "room", "location"),
        "names.xml": _write_document("names", names),
        "gestures.xml": _write_document("gestures", gestures),
        "questions.xml": _write_document("questions", questions),
        "categories.txt": _write_lines([*head, *singulars]),
        "whattosay.txt": _write_lines(each.text for each in ontology.of_class("whattosay")),
        ENTITIES_FILE: _write_document(
            "entities", (f"    <{each.entity_class}{_write_attributes(each)}/>" for each in own)
        ),
    }
    return {name: text for name, text in files.items() if text}


def _write_class(entity_class: EntityClass) -> str:
    values = {
        "token": entity_class.token,
        "singular": entity_class.singular,
        "plural": entity_class.plural,
        "hue": str(entity_class.hue),
        "said": entity_class.said,
        "closed": "true" if entity_class.is_closed else "false",
    }
    written = "".join(f" {key}={quoteattr(value)}" for key, value in values.items())
    return f"    <class{written}/>"


def _write_nested(ontology: Ontology, root: str, outer: str, inner: str) -> str:
    """Write two levels of rows; each inner row goes into the last outer row of its name before it, and beside them
    where it names none."""
    parts: list[tuple[Entity | None, list[Entity]]] = []
    for entity in ontology.entities:
        is_only_singular = set(entity.attributes) == {"singular"} and not entity.aliases
        is_of_categories_txt = entity.entity_class == "category" and is_only_singular
        if entity.entity_class == outer and not is_of_categories_txt:
            parts.append((entity, []))
        elif entity.entity_class == inner:
            name = entity.attribute(outer)
            part = next(
                (each for each in reversed(parts) if (each[0] and each[0].text) == name), None
            )
            if part is None:
                part = (Entity(outer, name) if name else None, [])
                parts.append(part)
            part[1].append(entity)
    rows: list[str] = []
    for holder, inside in parts:
        if holder is None:
            rows += (f"    <{inner}{_write_attributes(each)}/>" for each in inside)
            continue
        rows.append(f"    <{outer}{_write_attributes(holder, without=('singular',))}>")
        rows += (
            f"        <{inner}{_write_attributes(each, without=(outer,))}/>" for each in inside
        )
        rows.append(f"    </{outer}>")
    return _write_document(root, rows)


def _write_lines(lines: Iterable[str]) -> str:
    return "".join(f"{line}\n" for line in lines)


def _write_document(root: str, rows: Iterable[str]) -> str:
    lines = list(rows)
    return _write_lines([_DECLARATION, f"<{root}>", *lines, f"</{root}>"]) if lines else ""


def _write_attributes(entity: Entity, without: tuple[str, ...] = (), is_named: bool = True) -> str:
    values = {key: value for key, value in entity.attributes.items() if key not in without}
    named = {"name": entity.text} if is_named else {}
    aliases = {"aliases": ALIAS_SEPARATOR.join(entity.aliases)} if entity.aliases else {}
    written = {**named, **values, **aliases}
    return "".join(f" {key}={quoteattr(value)}" for key, value in written.items())
