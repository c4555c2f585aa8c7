"""Reads reports: what an HTML parser makes of them, by the standard."""

from __future__ import annotations

from collections.abc import Iterator

from justhtml import Element, JustHTML

# Attributes whose value a browser fetches, whatever the element.
LOADING = {"src", "srcset", "href", "xlink:href", "data", "poster", "action", "background", "ping"}


def parse(html: str) -> JustHTML:
    """Raises where the file is not as the HTML standard has it."""
    return JustHTML(html, strict=True, sanitize=False)


def elements(document: JustHTML) -> Iterator[Element]:
    return iter(document.query("*"))


def addresses(document: JustHTML) -> set[str]:
    """What the file refers to, apart from its own sections."""
    named = {
        str(value)
        for element in elements(document)
        for name, value in element.attrs.items()
        if name.lower() in LOADING
    }
    return {each for each in named if not each.startswith("#")}


def texts(document: JustHTML, selector: str) -> list[str]:
    """The text of each element, with single spaces."""
    return [" ".join(each.to_text().split()) for each in document.query(selector)]


def table(document: JustHTML, section: str, number: int = 0) -> list[list[str]]:
    """The cells of the body of a table of a section, row by row."""
    found = document.query(f"#{section} table")[number]
    return [
        [" ".join(cell.to_text().split()) for cell in row.query("th, td")]
        for row in found.query("tbody tr")
    ]
