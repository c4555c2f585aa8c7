"""Template tag: a share of answers with its interval, by a measure of the results."""

from __future__ import annotations

from django import template
from django.utils.html import format_html
from django.utils.safestring import SafeString

from annotations.showing.figures import decimals, percent
from parser_service.models import Evaluation
from parser_service.results.accuracy_cells import PLANS_NOT_COMPARED
from parser_service.results.measures import Measure, interval_of, is_known, share_of

register = template.Library()


@register.simple_tag
def measured(score: Evaluation, measure: str) -> SafeString:
    """Return the share that ``measure`` counts in percent, and the ends of its 95 % interval in a lighter tone; a dash
    where it is not known."""
    by = Measure(measure)
    if not is_known(score, by):
        return format_html('<span class="quiet" title="{}">–</span>', PLANS_NOT_COMPARED)
    share, *ends = (
        decimals(percent(each), 1) for each in (share_of(score, by), *interval_of(score, by))
    )
    return format_html('{} <span class="plus-minus">{}–{}</span>', share, *ends)
