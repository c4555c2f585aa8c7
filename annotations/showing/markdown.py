"""Markdown that people write, as HTML that is safe to show."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache
from typing import Any

from django.utils.safestring import SafeString, mark_safe
from markdown_it import MarkdownIt
from markdown_it.renderer import RendererHTML
from markdown_it.token import Token

DEEPEST = 20  # lists and quotations within each other
OF_PAGE = 2  # headings that the page has above those of the text
# A browser hands links of other schemes to the programs that have registered them.
_OTHER_SCHEME = re.compile(r"(?!(?:https?|mailto):)[a-z][a-z0-9+.-]*+:", re.IGNORECASE)


class _Markdown(MarkdownIt):
    def validateLink(self, url: str) -> bool:
        return _OTHER_SCHEME.match(url) is None and super().validateLink(url)


class _Renderer(RendererHTML):
    """Keeps links from passing on what they come from, and headings below those of the page."""

    def link_open(self, tokens: Sequence[Token], at: int, options: Any, env: Any) -> str:
        tokens[at].attrSet("rel", "noopener nofollow")
        return self.renderToken(tokens, at, options, env)

    def heading_open(self, tokens: Sequence[Token], at: int, options: Any, env: Any) -> str:
        tokens[at].tag = f"h{min(int(tokens[at].tag[1]) + OF_PAGE, 6)}"
        return self.renderToken(tokens, at, options, env)

    heading_close = heading_open

    def th_open(self, tokens: Sequence[Token], at: int, options: Any, env: Any) -> str:
        align_by_class(tokens[at])
        return self.renderToken(tokens, at, options, env)

    td_open = th_open


def align_by_class(token: Token) -> None:
    """Say by a class that a cell of a table is aligned right: styles of elements are refused by browsers here."""
    if str(token.attrs.pop("style", "")) == "text-align:right":
        token.attrJoin("class", "number")


_MARKDOWN = (
    _Markdown("commonmark", {"html": False, "maxNesting": DEEPEST}, renderer_cls=_Renderer)
    .enable("table")
    .disable("image")  # from elsewhere, they would tell who reads the page
)


@lru_cache(maxsize=256)
def rendered(text: str) -> SafeString:
    """Return CommonMark with tables as HTML.

    HTML in the text is shown as it is written, and so are links with another scheme than ``http``,
    ``https`` and ``mailto``. There are no images.
    """
    html: str = _MARKDOWN.render(text)
    return mark_safe(html)
