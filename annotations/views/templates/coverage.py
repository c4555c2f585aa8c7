"""Coverage that leads somewhere: the commands without a form, each with a link that begins its template."""

from __future__ import annotations

from django.http import HttpRequest, HttpResponse
from django.views.decorators.cache import never_cache

from annotations.forms import UncoveredFilters
from annotations.generation.uncovered import uncovered_of
from annotations.lists.listing import NumberedPages, render_list
from annotations.models import Duty, TaskCategory, World
from annotations.people.access import world_view

MOST_BARS = 8


@never_cache
@world_view(Duty.VIEW)
def uncovered(request: HttpRequest, world: World) -> HttpResponse:
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
    return render_list(request, "annotations/uncovered.html", context)
