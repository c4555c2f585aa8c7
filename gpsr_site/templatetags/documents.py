"""The tag that links a document: ``{% docs "guides/writing" %}``."""

from __future__ import annotations

from django import template
from django.utils.html import format_html
from django.utils.safestring import SafeString

from gpsr_site.documents import address_of, find_document

register = template.Library()


@register.simple_tag
def docs(target: str) -> SafeString:
    """Link a document, or a heading in it: ``guides/writing#repairs``. The link says what it leads to.

    An installation without its folder ``docs/`` has no such links.
    """
    name, _, anchor = target.partition("#")
    document = find_document(name)
    if document is None:
        return SafeString()
    heading = document.heading(anchor) if anchor else None
    words = heading.text if heading else document.title
    return format_html(
        '<a class="guide" href="{}">{}: {}</a>', address_of(target), document.shelf, words
    )
