"""The documents that come with the code: the Markdown files of ``docs/``, as HTML for pages of the site.

The site serves them itself, so that they can be read where there is no network. They are found by listing the
folder, so no address leads to another file. The list and each rendered document are kept while the process
runs.
"""

from __future__ import annotations

import posixpath
import re
import unicodedata
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import chain, pairwise
from pathlib import Path
from typing import Any

from django.conf import settings
from django.urls import reverse
from django.utils.safestring import SafeString, mark_safe
from markdown_it import MarkdownIt
from markdown_it.renderer import RendererHTML
from markdown_it.token import Token

from annotations.showing import markdown

INDEX = "index"
# What a document of each folder is called in a link.
SHELVES = {"guides": "Guide", "reference": "Reference", "design": "Design", "research": "Research"}
IMAGE_KINDS = {".png", ".svg"}
MOST_WORDS = 12  # that a search looks for
MOST_HITS = 30
EXCERPT = 90  # characters before and after the first word of a hit
# Before the ids of headings: the frame of a page has ids of its own, such as "keys".
ANCHOR = "doc-"
_LISTED = re.compile(r"\]\(([\w-]+/[\w-]+)\.md\)")  # on the first page
_ELSEWHERE = re.compile(r"[a-z][a-z0-9+.-]*:", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Heading:
    """A heading of a document: 1 for its title to 6, the id in its page, and its words."""

    level: int
    anchor: str
    text: str


@dataclass(frozen=True, slots=True)
class Passage:
    """A heading of a document with the plain text below it, up to the next heading."""

    heading: Heading
    text: str


@dataclass(frozen=True, slots=True)
class Document:
    """A document of ``docs/``. ``name`` is its path there without the ending, such as ``guides/writing``."""

    name: str
    headings: tuple[Heading, ...]
    html: SafeString
    passages: tuple[Passage, ...]

    @property
    def url(self) -> str:
        """Its address."""
        return address_of(self.name)

    @property
    def title(self) -> str:
        """The first heading."""
        return self.headings[0].text

    @property
    def shelf(self) -> str:
        """What its kind is called, such as ``Guide``; empty for the first page."""
        return SHELVES.get(self.name.partition("/")[0], "")

    @property
    def sections(self) -> list[Heading]:
        """The headings of its sections, in order."""
        return [heading for heading in self.headings if heading.level == 2]

    def heading(self, anchor: str) -> Heading | None:
        """Return the heading that a link in a document names; None where there is none."""
        return next((each for each in self.headings if each.anchor == ANCHOR + anchor), None)


@dataclass(frozen=True, slots=True)
class Hit:
    """A passage that holds all words of a search, cut before, at and after the first of them."""

    document: Document
    heading: Heading
    before: str
    word: str
    after: str

    @property
    def url(self) -> str:
        """The address of the heading."""
        return f"{self.document.url}#{self.heading.anchor}"


def search_documents(words: str) -> list[Hit]:
    """Return the passages that hold all of the words, in any case: those with them in a heading first.

    At most ``MOST_HITS``; only the first ``MOST_WORDS`` words count.
    """
    wanted = [re.compile(re.escape(word), re.IGNORECASE) for word in words.split()[:MOST_WORDS]]
    found = []
    for document in chain.from_iterable(shelves().values()) if wanted else ():
        for passage in document.passages:
            heads = f"{document.title} {passage.heading.text}"
            if all(word.search(heads) or word.search(passage.text) for word in wanted):
                in_heads = sum(bool(word.search(heads)) for word in wanted)
                found.append((-in_heads, _hit(document, passage, wanted)))
    return [hit for _, hit in sorted(found, key=lambda each: each[0])[:MOST_HITS]]


def _hit(document: Document, passage: Passage, wanted: list[re.Pattern[str]]) -> Hit:
    text = passage.text
    match = next(filter(None, (word.search(text) for word in wanted)), None)
    start, end = match.span() if match else (0, 0)
    before, after = text[max(0, start - EXCERPT) : start], text[end : end + EXCERPT]
    if start > EXCERPT:
        before = f"… {before.partition(' ')[2]}"
    if end + EXCERPT < len(text):
        after = f"{after.rpartition(' ')[0]} …"
    return Hit(document, passage.heading, before, text[start:end], after)


def shelves() -> dict[str, list[Document]]:
    """Return the documents of each shelf, in the order of the first page."""
    return _shelves(settings.DOCS_DIR)


def find_document(name: str) -> Document | None:
    """Return a document by its name; None where there is none."""
    path = _files(settings.DOCS_DIR).get(name)
    return _read(name, path) if path else None


def find_image(name: str) -> Path | None:
    """Return the file of an image by its name in ``docs/images/``; None where there is none."""
    return _images(settings.DOCS_DIR).get(name)


def address_of(target: str) -> str:
    """Return the address of a document, or of a heading in it: ``guides/writing#repairs``."""
    name, _, anchor = target.partition("#")
    if name == INDEX:
        address = reverse("documents")
    else:
        shelf, _, page = name.partition("/")
        address = reverse("document", kwargs={"shelf": shelf, "page": page})
    return f"{address}#{ANCHOR}{anchor}" if anchor else address


@cache
def _files(folder: Path) -> dict[str, Path]:
    shelves = [path for shelf in SHELVES for path in (folder / shelf).glob("*.md")]
    files = [path for path in (folder / f"{INDEX}.md", *shelves) if path.is_file()]
    return {path.relative_to(folder).with_suffix("").as_posix(): path for path in files}


@cache
def _shelves(folder: Path) -> dict[str, list[Document]]:
    files = _files(folder)
    names = _LISTED.findall(files[INDEX].read_text(encoding="utf-8")) if INDEX in files else []
    documents = [_read(name, files[name]) for name in dict.fromkeys(names) if name in files]
    return {
        shelf: [each for each in documents if each.name.startswith(f"{shelf}/")]
        for shelf in SHELVES
    }


@cache
def _images(folder: Path) -> dict[str, Path]:
    paths = (folder / "images").glob("*")
    return {path.name: path for path in paths if path.suffix in IMAGE_KINDS}


class _Renderer(RendererHTML):
    """Renders tables and code so that wide ones scroll, by keyboard as well."""

    def table_open(self, tokens: Sequence[Token], at: int, options: Any, env: Any) -> str:
        table = self.renderToken(tokens, at, options, env)
        return f'<div class="table-wrap table-wrap--scroll" tabindex="0">{table}'

    def table_close(self, tokens: Sequence[Token], at: int, options: Any, env: Any) -> str:
        return f"{self.renderToken(tokens, at, options, env)}</div>"

    def fence(self, tokens: Sequence[Token], at: int, options: Any, env: Any) -> str:
        return super().fence(tokens, at, options, env).replace("<pre>", '<pre tabindex="0">', 1)

    def code_block(self, tokens: Sequence[Token], at: int, options: Any, env: Any) -> str:
        block = super().code_block(tokens, at, options, env)
        return block.replace("<pre>", '<pre tabindex="0">', 1)


# The documents are a part of the code: HTML in them is meant.
_MARKDOWN = MarkdownIt("commonmark", {"html": True}, renderer_cls=_Renderer).enable("table")


@cache
def _read(name: str, path: Path) -> Document:
    tokens = _MARKDOWN.parse(path.read_text(encoding="utf-8"))
    headings = tuple(_mark_headings(tokens))
    passages = tuple(_passages(tokens, headings))
    for token in chain.from_iterable((each, *(each.children or ())) for each in tokens):
        _lead_to_pages(token, name)
        markdown.align_by_class(token)
    html: str = _MARKDOWN.renderer.render(tokens, _MARKDOWN.options, {})
    return Document(name, headings, mark_safe(html), passages)


def _mark_headings(tokens: Sequence[Token]) -> Iterator[Heading]:
    """Give each heading an id, and yield them in order."""
    taken: set[str] = set()
    for opening, inside in pairwise(tokens):
        if opening.type != "heading_open":
            continue
        text = "".join(each.content for each in inside.children or ())
        slug = slug_of(text)
        anchor = ANCHOR + slug
        number = 1
        while anchor in taken:
            anchor, number = f"{ANCHOR}{slug}_{number}", number + 1
        taken.add(anchor)
        opening.attrSet("id", anchor)
        yield Heading(int(opening.tag[1]), anchor, text)


def _passages(tokens: Sequence[Token], headings: Sequence[Heading]) -> Iterator[Passage]:
    at = [index for index, token in enumerate(tokens) if token.type == "heading_open"]
    for heading, (start, end) in zip(headings, pairwise([*at, len(tokens)]), strict=True):
        text = " ".join(map(_plain, tokens[start + 3 : end]))  # after the heading's own three
        yield Passage(heading, " ".join(text.split()))


def _plain(token: Token) -> str:
    if token.type == "inline":
        return "".join(map(_plain, token.children or ()))
    if token.type in ("softbreak", "hardbreak"):
        return " "
    return token.content if token.type in ("text", "code_inline", "fence", "code_block") else ""


def slug_of(text: str) -> str:
    """Return what links in a document call the heading ``text``; ``make docs`` does the same."""
    words = re.sub(r"[^\w\s-]", "", unicodedata.normalize("NFKC", text)).strip().lower()
    return re.sub(r"[-\s]+", "-", words)


def _lead_to_pages(token: Token, name: str) -> None:
    """Let a link or an image of the document ``name`` lead to an address of the site."""
    key = {"link_open": "href", "image": "src"}.get(token.type)
    target = str(token.attrs.get(key, "")) if key else ""
    if not key or _ELSEWHERE.match(target):
        return
    path, _, anchor = target.partition("#")
    meant = posixpath.normpath(posixpath.join(posixpath.dirname(name), path)) if path else name
    if key == "src":
        token.attrSet(key, reverse("document_image", kwargs={"name": posixpath.basename(meant)}))
    else:
        token.attrSet(key, address_of(f"{meant.removesuffix('.md')}{anchor and '#'}{anchor}"))
