"""An HTML file of sections, written one after the other."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from django.template.loader import render_to_string
from django.utils import timezone

FOLDER = "parser_service/report"
ROWS_AT_ONCE = 100  # of a table that is written as a stream
SHOWN_INSTEAD = "\ufffd"
# Characters that stand in no HTML file, whatever wrote them.
_UNWRITABLE = re.compile(
    r"[\x00-\x08\x0b-\x1f\x7f-\x9f\ud800-\udfff\ufdd0-\ufdef\ufffe\uffff]"
    r"|["
    + "".join(
        f"{chr(plane + 0xFFFE)}{chr(plane + 0xFFFF)}" for plane in range(0x10000, 0x110000, 0x10000)
    )
    + "]"
)


@dataclass(frozen=True, slots=True)
class Section:
    """A part of the report with an entry in its table of contents.

    ``template`` is a file in ``FOLDER``; ``context`` is called when the section is written. Where there are
    ``rows``, each batch of them is written by the template ``template`` with ``_rows`` after its name, and
    ``after`` closes what the first one has opened.
    """

    anchor: str
    title: str
    template: str
    context: Callable[[], Mapping[str, Any]]
    rows: Callable[[], Iterable[Any]] | None = None
    after: str = "</tbody></table></div></section>"


def write_document(
    title: str, about: Mapping[str, Any], sections: Sequence[Section]
) -> Iterator[str]:
    """Yield the file in pieces."""
    head = {**about, "title": title, "sections": sections, "made_at": timezone.now()}
    yield _write("begin", head)
    for section in sections:
        values = {**about, **section.context(), "section": section}
        yield _write(section.template, values)
        if section.rows is not None:
            batch: list[Any] = []
            for row in section.rows():
                batch.append(row)
                if len(batch) == ROWS_AT_ONCE:
                    yield _write(f"{section.template}_rows", {**values, "rows": batch})
                    batch = []
            if batch:
                yield _write(f"{section.template}_rows", {**values, "rows": batch})
            yield section.after
    yield _write("end", {})


def _write(name: str, values: Mapping[str, Any]) -> str:
    text = render_to_string(f"{FOLDER}/{name}.html", dict(values))
    return _UNWRITABLE.sub(SHOWN_INSTEAD, text)
