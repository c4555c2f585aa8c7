"""What templates say instead of spelling it out: forms, commands, figures."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

from django import template
from django.utils import timezone
from django.utils.html import format_html, format_html_join
from django.utils.safestring import SafeString

from annotations.showing import difference, form_of, gloss_of, pieces_of, shown, wildcard_class

register = template.Library()

PATTERN_TOKEN = re.compile(r"(\$\w+|\{[^{}]*\})")


@register.inclusion_tag("_logical_form.html", takes_context=True)
def logical_form(
    context: Any, text: str, gloss: bool = False, tools: bool = False
) -> dict[str, Any]:
    """A form in the notation that the page shows; with ``gloss`` its English sentence beneath."""
    form = shown(text)
    if gloss and form.corpus:
        form = replace(form, gloss=gloss_of(context["world"], form_of(text)))
    return {"form": form, "tools": tools}


@register.inclusion_tag("_chips.html")
def command(text: str) -> dict[str, Any]:
    """A command with its class tokens as chips."""
    return {"pieces": pieces_of(text)}


@register.simple_tag
def pattern(text: str) -> SafeString:
    """A pattern or an expansion with its nonterminals and wildcards marked."""
    return format_html_join("", "{}", ((_marked(token),) for token in PATTERN_TOKEN.split(text)))


def _marked(token: str) -> str:
    if token.startswith("$"):
        return format_html('<span class="lf-nonterminal">{}</span>', token)
    if token.startswith("{"):
        hue = wildcard_class(token)
        return format_html('<span class="lf-slot" data-class="{}">{}</span>', hue, token)
    return token


@register.inclusion_tag("_form_diff.html")
def expected_form(expected: str, predicted: str) -> dict[str, Any]:
    """The annotated form, what the prediction lacks marked."""
    return {"pieces": difference(expected, predicted)[0]}


@register.inclusion_tag("_form_diff.html")
def predicted_form(expected: str, predicted: str) -> dict[str, Any]:
    """The predicted form, what it has beyond the annotated one marked."""
    return {"pieces": difference(expected, predicted)[1]}


@register.filter
def percent(fraction: float | None) -> float | None:
    """A fraction of 1 in percent; None for what is no number."""
    return 100 * fraction if isinstance(fraction, float | int) else None


@register.filter
def figure(number: float | None) -> str:
    """A count with commas between thousands."""
    return "" if number is None else f"{number:,}"


@register.filter
def decimals(number: float | None, digits: int = 2) -> str:
    """A number with so many decimals; a dash where there is none."""
    return "–" if number is None else f"{number:,.{digits}f}"


@register.filter
def duration(seconds: float | None) -> str:
    """Seconds as ``48 s``, ``3 min 20 s`` or ``2 h 5 min``; nothing for None."""
    if seconds is None:
        return ""
    if seconds < 10:
        return f"{seconds:.1f} s"
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    minutes, rest = divmod(whole, 60)
    return f"{minutes} min {rest} s" if minutes < 60 else f"{minutes // 60} h {minutes % 60} min"


@register.filter
def ago(moment: Any) -> SafeString:
    """How long ago, with the moment itself on hover."""
    if moment is None:
        return format_html("")
    absolute = timezone.localtime(moment)
    return format_html(
        '<time datetime="{}" title="{}">{}</time>',
        absolute.isoformat(),
        f"{absolute:%Y-%m-%d %H:%M:%S %Z}",
        _passed((timezone.now() - moment).total_seconds()),
    )


def _passed(seconds: float) -> str:
    for size, unit in ((86400, "d"), (3600, "h"), (60, "min")):
        if seconds >= size:
            return f"{int(seconds // size)} {unit} ago"
    return "just now"
