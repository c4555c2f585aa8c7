"""A filter that names the kinds of probes."""

from __future__ import annotations

from django import template

from parser_service.reviews.probe_kinds import PROBE_KINDS

register = template.Library()


@register.filter
def probe_kind(kind: str) -> str:
    """Write the name of a kind of probe; an unknown one as it is."""
    return {str(name): words for name, words in PROBE_KINDS.items()}.get(kind, kind)
