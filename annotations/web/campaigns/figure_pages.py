"""Figures of paraphrases: how many there are, how far they are from their prompts, and who wrote them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from django.http import HttpResponse
from django.shortcuts import render
from django.utils.http import urlencode

from annotations.campaigns.contributor_figures import contributors_of
from annotations.campaigns.paraphrase_figures import (
    EDIT_BINS,
    JACCARD_BINS,
    ParaphraseFigures,
    figures_of,
    form_counts,
    target_of,
)
from annotations.models import Duty, World
from annotations.people.access import WorldRequest, world_view
from annotations.showing.figures import decimals
from annotations.showing.listing import NumberedPages, Sort, render_list
from annotations.web.campaigns.figure_forms import SHORT, FigureFilters, FormCountFilters

FORM_SORTS = {
    "lacks": Sort("Still short", "-lacks", is_number=True),
    "category": Sort("Task category", "task_category"),
    "people": Sort("People", "-people", is_number=True),
    "models": Sort("Models", "-models", is_number=True),
}
CONTRIBUTOR_SORTS = {
    "flags": Sort("Flagged", "-flagged", is_number=True),
    "acceptance": Sort("Accepted", "acceptance_or_last", is_number=True),
    "pace": Sort("Seconds a rewrite", "pace_or_last", is_number=True),
    "answers": Sort("Answers", "-answers", is_number=True),
}


@world_view(Duty.VIEW)
def paraphrase_figures(request: WorldRequest, world: World) -> HttpResponse:
    """Show how many paraphrases there are, their distances and their vocabulary, people and models apart."""
    filters = FigureFilters(request, world, request.GET)
    figures = figures_of(world, filters.chosen)
    context = {
        "filters": filters,
        "figures": figures,
        "sides": sides_of(figures),
        "edit_chart": edit_chart(figures),
        "jaccard_chart": jaccard_chart(figures),
        "growth_chart": growth_chart(figures),
        "short_query": query_of(campaign=filters["campaign"].value(), short=SHORT),
        "launch_query": query_of(target_per_form=figures.target),
    }
    return render(request, "annotations/campaigns/figures.html", context)


@world_view(Duty.VIEW)
def paraphrase_forms(request: WorldRequest, world: World) -> HttpResponse:
    """List the forms with their paraphrases, those that lack most first."""
    filters = FormCountFilters(request, world, request.GET)
    campaign = filters.chosen
    asked = filters.cleaned_data
    target = asked.get("target") or target_of(campaign)
    category, short = asked.get("task_category"), asked.get("short")
    rows = [
        row
        for row in form_counts(world, campaign, target)
        if (not category or row.task_category == category)
        and (not short or (row.lacks > 0) == (short == SHORT))
    ]
    listing = NumberedPages(request, filters, rows, sorts=FORM_SORTS)
    shown = world.logical_forms.filter(text__in=[row.form for row in listing.rows])
    keys = dict(shown.values_list("text", "pk"))
    context = {
        "listing": listing,
        "rows": [(row, keys.get(row.form)) for row in listing.rows],
        "target": target,
        "launch_query": query_of(target_per_form=target, task_categories=category),
    }
    return render_list(request, "annotations/campaigns/figure_forms.html", context)


@world_view(Duty.REVIEW)
def paraphrase_contributors(request: WorldRequest, world: World) -> HttpResponse:
    """List who has contributed, by pseudonyms, with pace, acceptance and flags."""
    filters = FigureFilters(request, world, request.GET)
    rows = contributors_of(world, filters.chosen)
    listing = NumberedPages(request, filters, rows, sorts=CONTRIBUTOR_SORTS)
    context = {"listing": listing}
    return render_list(request, "annotations/campaigns/figure_contributors.html", context)


def query_of(**values: str | int | None) -> str:
    """Return the query of an address, without what is empty."""
    return urlencode({name: value for name, value in values.items() if value})


def sides_of(figures: ParaphraseFigures) -> list[tuple[str, Any]]:
    """Return people and models, each with a name, those that have written anything."""
    sides = (("people", figures.people), ("models", figures.models))
    return [(name, side) for name, side in sides if side.count]


def edit_chart(figures: ParaphraseFigures) -> dict[str, Any]:
    step = round(EDIT_BINS.width) - 1
    *closed, last = map(round, EDIT_BINS.starts)
    values = [*(f"{start}–{start + step}" for start in closed), f"{last} or more"]
    lines = [(name, side.edit_counts) for name, side in sides_of(figures)]
    return _histogram("Levenshtein distance, characters", values, lines)


def jaccard_chart(figures: ParaphraseFigures) -> dict[str, Any]:
    ends = [*JACCARD_BINS.starts, 1]
    values = [f"{decimals(start, 1)}–{decimals(end, 1)}" for start, end in pairwise(ends)]
    lines = [(name, side.jaccard_counts) for name, side in sides_of(figures)]
    return _histogram("Jaccard distance of the words", values, lines)


def _histogram(
    label: str, values: list[str], lines: Sequence[tuple[str, Sequence[int]]]
) -> dict[str, Any]:
    """Return bars in percent, so that a few paraphrases compare with many."""
    return {
        "kind": "bars",
        "x": {"label": label, "values": values},
        "y": {"label": "paraphrases", "unit": "%"},
        "series": [
            {"name": name, "values": [round(100 * each / sum(counts), 1) for each in counts]}
            for name, counts in lines
        ],
        "done": True,
    }


def growth_chart(figures: ParaphraseFigures) -> dict[str, Any]:
    at = figures.growth_at
    return {
        "x": {"label": "paraphrases", "values": at},
        "y": {"label": "different words"},
        "series": [
            {
                "name": name,
                "values": [side.growth[each - 1] if each <= side.count else None for each in at],
            }
            for name, side in sides_of(figures)
        ],
        "done": True,
    }
