"""The command grammar: its productions, what is wrong with it, and how far templates cover it."""

from __future__ import annotations

from itertools import groupby

from django.http import HttpRequest, HttpResponse
from django.shortcuts import render
from django.views.decorators.cache import never_cache

from annotations.generation.coverage import coverage_of
from annotations.language.errors import LanguageError
from annotations.lists.filters import ProductionFilters
from annotations.lists.listing import Listing, Sort, render_list
from annotations.models import Duty, Production, World
from annotations.models.description import Subject
from annotations.people.access import world_view

SORTS = {
    "position": Sort("File and line", "position"),
    "nonterminal": Sort("Nonterminal", "nonterminal"),
}
PAGE_SIZE = 200


@world_view(Duty.VIEW)
def grammar(request: HttpRequest, world: World) -> HttpResponse:
    """List the productions by nonterminal, with the checker's remarks."""
    rows = Production.objects.filter(grammar__world=world)
    listing = Listing(request, ProductionFilters, rows, SORTS, size=PAGE_SIZE)
    grouped = groupby(listing.rows, key=lambda row: (row.source, row.nonterminal))
    context = {
        "listing": listing,
        "groups": [(*key, list(lines)) for key, lines in grouped],
        "problems": world.problems.filter(subject=Subject.GRAMMAR),
    }
    return render_list(request, "annotations/grammar.html", context)


@never_cache
@world_view(Duty.VIEW)
def coverage(request: HttpRequest, world: World) -> HttpResponse:
    """Show size, samples and coverage by task category: a part of the grammar page, loaded after it."""
    try:
        context = {"categories": coverage_of(world)}
    except LanguageError as error:
        context = {"problems": [error.problem]}
    return render(request, "annotations/_coverage.html", context)
