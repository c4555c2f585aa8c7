"""The command grammar: its productions, listed and edited, checked as one types, with what saving would do."""

from __future__ import annotations

from itertools import groupby
from typing import Any

from django.http import Http404, HttpResponse, JsonResponse
from django.shortcuts import redirect, render
from django.urls import reverse

from annotations.editing.edits import Overtaken, add
from annotations.generation.production_check import (
    ProductionEdit,
    assist_production,
    check_production,
    consequences_of_production,
)
from annotations.language.texts import MAX_PATTERN
from annotations.models import Duty, Production, SemanticTemplate, World
from annotations.models.description import ProblemSubject
from annotations.people.access import READ_AND_WRITE, WRITE, WorldRequest, world_view
from annotations.rows.row_kinds import KINDS
from annotations.showing.listing import Listing, Sort, render_list
from annotations.showing.paging import number_in
from annotations.web.description.description_filters import ProductionFilters
from annotations.web.description.entity_pages import tell_saved
from annotations.web.description.production_forms import (
    ProductionForm,
    initial_values,
    sources_of,
    unsaved_production,
)
from annotations.web.description.template_pages import has_grammar
from annotations.web.editing.consequence_presentation import groups_of
from annotations.web.editing.merge_pages import merge_page, save_edit
from annotations.web.forms import choice_field, posted

SORTS = {
    "position": Sort("File and line", "position"),
    "nonterminal": Sort("Nonterminal", "nonterminal"),
}
PAGE_SIZE = 200


@world_view(Duty.VIEW)
def grammar(request: WorldRequest, world: World) -> HttpResponse:
    """List the productions by nonterminal, with the checker's problems."""
    rows = Production.objects.filter(grammar__world=world)
    listing = Listing(request, ProductionFilters, rows, SORTS, size=PAGE_SIZE)
    grouped = groupby(listing.rows, key=lambda row: (row.source, row.nonterminal))
    context = {
        "listing": listing,
        "groups": [(*key, list(lines)) for key, lines in grouped],
        "problems": world.problems.filter(subject=ProblemSubject.GRAMMAR),
    }
    return render_list(request, "annotations/description/grammar.html", context)


@world_view(Duty.VIEW, READ_AND_WRITE, write_duty=Duty.ANNOTATE)
def production(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show a line of the grammar with the others of its nonterminal; annotators change it."""
    row, is_there = KINDS["production"].row_or_last_known(world, pk)
    if not is_there and request.method != "POST":
        return redirect("history", world=world.name, kind="production", pk=pk)
    form = ProductionForm(world, row, posted(request), initial=initial_values(row))
    if request.method == "POST" and form.is_valid():
        try:
            row = save_edit(request, row, form, {"expansion": form.cleaned_data["expansion"]})
        except Overtaken as clash:
            address = reverse("production_check", kwargs={"world": world.name})
            check_url = f"{address}?production={row.pk}"
            return merge_page(request, row, form, clash, initial_values, check_url=check_url)
        tell_saved(request, f"Saved as version {row.version}.", form.remarks)
        return redirect("production", world=world.name, pk=pk)
    lines = Production.objects.filter(grammar__world=world, nonterminal=row.nonterminal)
    context = {
        "row": row,
        "form": form,
        "checked": form.checked or check_production(ProductionEdit.of_stored(row)),
        "lines": lines.exclude(pk=row.pk),
        "meanings": SemanticTemplate.objects.filter(grammar__world=world).for_nonterminal(
            row.nonterminal
        ),
        "query": f"?production={row.pk}",
        **_completion(world, row.source),
    }
    return render(request, "annotations/description/production.html", context)


@world_view(Duty.ANNOTATE, READ_AND_WRITE)
def production_new(request: WorldRequest, world: World) -> HttpResponse:
    """Add a line to the grammar."""
    if not has_grammar(world):
        return render(request, "annotations/description/production_needs_grammar.html")
    asked = {name: request.GET.get(name, "") for name in ("nonterminal", "source")}
    form = ProductionForm(world, None, posted(request), initial=asked)
    if request.method == "POST" and form.is_valid():
        row = add(unsaved_production(world, form), request.user, form.cleaned_data["once"])
        tell_saved(request, "Added.", form.remarks)
        return redirect("production", world=world.name, pk=row.pk)
    context = {
        "form": form,
        "checked": form.checked,
        **_completion(world, asked["source"] or sources_of(world)[0]),
    }
    return render(request, "annotations/description/production.html", context)


@world_view(Duty.ANNOTATE, WRITE)
def production_check(request: WorldRequest, world: World) -> JsonResponse:
    """Check what is typed, for the editor."""
    edit = _read_typed(request, world)
    return JsonResponse(assist_production(edit) if edit else {"problems": [], "slots": []})


@world_view(Duty.ANNOTATE, WRITE)
def production_preview(request: WorldRequest, world: World) -> HttpResponse:
    """Preview the typed production: what it expands to, and what saving it would change."""
    edit = _read_typed(request, world)
    context: dict[str, Any] = {"checked": check_production(edit) if edit else None}
    if edit and not context["checked"].has_errors:
        context["expected"] = consequences_of_production(edit)
        context["groups"] = groups_of(context["expected"])
    return render(request, "annotations/description/_production_preview.html", context)


def _read_typed(request: WorldRequest, world: World) -> ProductionEdit | None:
    """Return the production as typed, or None while a field is empty or invalid.

    The URL may name a stored row as ``production``. Raises Http404 if that is not in this world.
    """
    row = None
    if key := request.GET.get("production", ""):
        row = Production.objects.filter(grammar__world=world, pk=number_in(key)).first()
        if row is None:
            raise Http404("No such production.")
    form = ProductionForm(world, row, request.POST, initial=initial_values(row) if row else {})
    form.is_valid()
    names = ("source", "nonterminal", "expansion")
    source, nonterminal, expansion = (
        form.cleaned_data.get(name) or form[name].value() or "" for name in names
    )
    if not expansion.strip() or not choice_field(form, "source").valid_value(source):
        return None
    if len(expansion) > MAX_PATTERN or "\0" in f"{source}{nonterminal}{expansion}":
        return None
    if "nonterminal" in form.errors:
        return None
    return ProductionEdit(world, source, nonterminal, expansion, row)


def _completion(world: World, source: str) -> dict[str, Any]:
    """Return the task category whose nonterminals the editor offers."""
    edit = ProductionEdit(world, source, "", "")
    return {"category": next(edit.categories(), None)}
