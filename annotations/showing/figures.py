"""Write numbers, durations and moments as pages show them."""

from __future__ import annotations

from typing import Any

from django.utils import timezone
from django.utils.html import format_html
from django.utils.safestring import SafeString


def percent(fraction: float | None) -> float | None:
    """Convert a fraction to percent; None for what is not a number."""
    return 100 * fraction if isinstance(fraction, float | int) else None


def figure(number: float | None) -> str:
    """Write a count with commas between thousands."""
    return "" if number is None else f"{number:,}"


def decimals(number: float | None, digits: int = 2) -> str:
    """Write a number with ``digits`` decimals; a dash for None. Nothing that rounds to 0 has a sign."""
    if number is None:
        return "–"
    return f"{number:z,.{digits}f}".replace("-", "−")


def signed(number: float) -> str:
    """Write a difference with one decimal and its sign; nothing that rounds to 0 has one."""
    rounded = round(number, 1)
    return f"{rounded:+.1f}".replace("-", "−") if rounded else "0.0"


def p_value(p: float) -> str:
    """Write the probability of a test."""
    return "< 0.001" if p < 0.001 else f"{p:.3f}"


def duration(seconds: float | None) -> str:
    """Write seconds as ``48 s``, ``3 min 20 s`` or ``2 h 5 min``; nothing for None."""
    if seconds is None:
        return ""
    if seconds < 10:
        return f"{seconds:.1f} s"
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    minutes, rest = divmod(whole, 60)
    return f"{minutes} min {rest} s" if minutes < 60 else f"{minutes // 60} h {minutes % 60} min"


def rough_duration(seconds: float | None) -> str:
    """Write an estimate: ``a few seconds``, ``about 12 min``, ``about 3 h``; nothing for None."""
    if seconds is None:
        return ""
    if seconds < 15:
        return "a few seconds"
    if seconds < 90:
        return "about a minute"
    minutes = round(seconds / 60)
    return f"about {minutes} min" if minutes < 90 else f"about {round(minutes / 60)} h"


def ago(moment: Any) -> SafeString:
    """Write how long ago a moment was, with the moment itself on hover."""
    if moment is None:
        return format_html("")
    absolute = timezone.localtime(moment)
    seconds = (timezone.now() - moment).total_seconds()
    units = ((86400, "d"), (3600, "h"), (60, "min"))
    ages = (f"{int(seconds // size)} {unit} ago" for size, unit in units if seconds >= size)
    return format_html(
        '<time datetime="{}" title="{}">{}</time>',
        absolute.isoformat(),
        f"{absolute:%Y-%m-%d %H:%M:%S %Z}",
        next(ages, "just now"),
    )
