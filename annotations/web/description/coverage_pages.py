"""How far templates cover the grammar, and the commands without a form, each with a link to begin its template."""

from __future__ import annotations

from typing import Any

from django import forms
from django.http import HttpResponse
from django.shortcuts import render
from django.views.decorators.cache import never_cache

from annotations.generation.coverage import coverage_of
from annotations.generation.uncovered import uncovered_of
from annotations.language.texts import LanguageError
from annotations.models import Duty, TaskCategory, World
from annotations.people.access import WorldRequest, world_view
from annotations.showing.listing import NumberedPages, render_list
from annotations.web.forms import choice_field

MOST_BARS = 8


class UncoveredFilters(forms.Form):
    """What the commands without a form may be filtered by. Each name is a parameter of the page's URL."""

    q = forms.CharField(
        label="Search",
        required=False,
        max_length=200,
        widget=forms.SearchInput(attrs={"placeholder": "Search"}),
    )
    task_category = forms.ChoiceField(label="Task category", required=False)
    nonterminal = forms.ChoiceField(label="Nonterminal", required=False)

    def __init__(self, categories: list[str], nonterminals: list[str], *args: Any) -> None:
        super().__init__(*args)
        choice_field(self, "task_category").choices = choices_of("Task category", categories)
        names = {name: f"${name}" for name in nonterminals}
        choice_field(self, "nonterminal").choices = [("", "Nonterminal: any"), *names.items()]


def choices_of(label: str, names: list[str]) -> list[tuple[str, str]]:
    return [("", f"{label}: any"), *((name, name) for name in names)]


@never_cache
@world_view(Duty.VIEW)
def coverage(request: WorldRequest, world: World) -> HttpResponse:
    """Show size, samples and coverage by task category: a part of the grammar page, loaded after it."""
    try:
        context: dict[str, Any] = {"categories": coverage_of(world)}
    except LanguageError as error:
        context = {"problems": [error.problem]}
    return render(request, "annotations/description/_coverage.html", context)


@never_cache
@world_view(Duty.VIEW)
def uncovered(request: WorldRequest, world: World) -> HttpResponse:
    """List the commands of the grammar that no template gives a form."""
    categories = TaskCategory.objects.filter(grammar__world=world)
    names = [each.name for each in categories]
    chosen = request.GET.get("task_category", "")
    report = uncovered_of(world, chosen if chosen in names else "")
    form = UncoveredFilters(names, [each.nonterminal for each in report.shares], request.GET)
    form.is_valid()  # what is not valid is ignored, and said
    filters = form.cleaned_data
    commands = report.matching(filters.get("nonterminal", ""), filters.get("q", ""))
    listing = NumberedPages(request, form, commands)
    context = {
        "categories": categories,
        "report": report,
        "problems": report.problems,
        "bars": [(each, listing.url(nonterminal=each.nonterminal)) for each in report.shares],
        "listing": listing,
        "n_bars": MOST_BARS,
        "rest_slice": f"{MOST_BARS}:",
    }
    return render_list(request, "annotations/description/uncovered.html", context)
