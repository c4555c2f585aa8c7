"""Read XML into elements with positions; refuse entities and external references."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from io import BytesIO
from xml.sax import SAXParseException
from xml.sax.handler import ContentHandler
from xml.sax.xmlreader import AttributesImpl, InputSource, XMLReader

from defusedxml import DefusedXmlException
from defusedxml.sax import make_parser

from annotations.language.errors import LanguageError, Position
from annotations.language.limits import MAX_NESTING


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
        values = {key: " ".join(value.split()) for key, value in attrs.items()}
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
        element.text = " ".join("".join(self._pieces.pop()).split())

    def characters(self, content: str) -> None:
        self._pieces[-1].append(content)
