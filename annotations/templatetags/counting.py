"""Filters that count in words."""

from __future__ import annotations

import re

from django import template

from annotations.showing.listing import say_total

register = template.Library()


register.filter("total", say_total)


@register.filter
def of_rows(total: int, plural: str) -> str:
    """Write ``1,211 commands``, ``over 10,000 commands`` or ``1 command``; ``plural`` is the noun of the list."""
    if total != 1:
        return f"{say_total(total)} {plural}"
    return "1 " + re.sub(r"(ie)?s\b", lambda ending: "y" if ending[1] else "", plural, count=1)
