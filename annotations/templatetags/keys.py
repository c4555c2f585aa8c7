"""Template tags for keys, all from one table: ``annotations.showing.keys``."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from django import template
from django.utils.html import format_html
from django.utils.safestring import SafeString

from annotations.showing.keys import EVERYWHERE, IN_EDITORS, KEYS, PageKey, actions_by_key

register = template.Library()


@register.simple_tag
def key(action: str) -> SafeString:
    """Show the key of an action."""
    return format_html("<kbd>{}</kbd>", KEYS[action].keys[0])


@register.simple_tag
def name_of_key(action: str) -> str:
    """Write the key of an action, for ``aria-keyshortcuts`` and titles."""
    return KEYS[action].keys[0]


@register.simple_tag
def actions_of_keys() -> str:
    """Write what each key does as JSON, for the scripts."""
    return json.dumps(actions_by_key())


@register.simple_tag
def all_keys() -> tuple[PageKey, ...]:
    """Return the keys of all pages and of editors."""
    return (*EVERYWHERE, *IN_EDITORS)


@register.inclusion_tag("_keys_list.html")
def list_of_keys(keys: Sequence[PageKey]) -> dict[str, Any]:
    """Show keys with what they do."""
    return {"keys": keys}
