"""XML text → elements that know where they stand, with entities and external references refused."""

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

DEEPEST = 64


@dataclass(slots=True)
class Element:
    """One element: its own attributes (values with single spaces), text and children."""

    tag: str
    position: Position
    attributes: dict[str, str] = field(default_factory=dict)
    children: list[Element] = field(default_factory=list)
    text: str = ""

    def each(self, tag: str) -> Iterator[Element]:
        """The children of a tag, in order."""
        return (child for child in self.children if child.tag == tag)


def read_xml(text: str, source: str, root: str) -> Element:
    """Reads a document whose outermost element is ``root``.

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
    except SAXParseException as trouble:
        line, column = trouble.getLineNumber() or 1, trouble.getColumnNumber() or 0
        place = Position(source, line, column + 1)
        raise LanguageError(
            f"this is not well-formed XML: {trouble.getMessage()}", place, "mend the markup here"
        ) from None
    except DefusedXmlException:
        raise LanguageError(
            "the document declares entities or refers to another file, which is refused",
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
    """Collects elements; the parser tells it through the locator where it is."""

    def __init__(self, source: str) -> None:
        super().__init__()
        self._source = source
        self._open: list[Element] = []
        self.root = Element("", Position(source))

    @property
    def position(self) -> Position:
        locator = self._locator  # type: ignore[attr-defined]
        line, column = locator.getLineNumber() or 1, locator.getColumnNumber() or 0
        return Position(self._source, line, column + 1)

    def startElement(self, name: str, attrs: AttributesImpl) -> None:
        values = {key: " ".join(value.split()) for key, value in attrs.items()}
        element = Element(name, self.position, values)
        if len(self._open) >= DEEPEST:
            raise LanguageError(
                f"elements nest more than {DEEPEST} deep", self.position, "close them earlier"
            )
        if self._open:
            self._open[-1].children.append(element)
        else:
            self.root = element
        self._open.append(element)

    def endElement(self, name: str) -> None:
        element = self._open.pop()
        element.text = " ".join(element.text.split())

    def characters(self, content: str) -> None:
        self._open[-1].text += content
