"""Productions: written in place, checked while they are, with what saving them would do."""

from __future__ import annotations

from typing import Any

from django.http import Http404, HttpRequest, HttpResponse, JsonResponse
from django.shortcuts import redirect, render
from django.urls import reverse

from annotations.checking import (
    ProductionEdit,
    assist_production,
    check_production,
    consequences_of_production,
)
from annotations.consequence_presentation import groups_of
from annotations.editing.edits import Overtaken, add
from annotations.forms import posted
from annotations.models import Duty, Editable, Production, World
from annotations.people.access import READ_AND_WRITE, WRITE, world_view
from annotations.rows.composition import own_category
from annotations.rows.kinds import KINDS
from annotations.views.description.entities import tell_saved
from annotations.views.description.production_forms import ProductionForm, sources_of
from annotations.views.editing.history import number_in
from annotations.views.editing.merging import merge_page, save_edit
from annotations.views.templates.templates import has_grammar


@world_view(Duty.VIEW, READ_AND_WRITE, write_duty=Duty.ANNOTATE)
def production(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """Show a line of the grammar with the others of its nonterminal; annotators change it."""
    row, is_there = KINDS["production"].row_or_last_known(world, pk)
    if not is_there and request.method != "POST":
        return redirect("history", world=world.name, kind="production", pk=pk)
    form = ProductionForm(world, row, posted(request), initial=initial_values(row))
    if request.method == "POST" and form.is_valid():
        try:
            row = save_edit(request, row, form, {"expansion": form.cleaned_data["expansion"]})
        except Overtaken as clash:
            check_url = _check_url(world, row)
            return merge_page(request, row, form, clash, initial_values, check_url=check_url)
        tell_saved(request, f"Saved as version {row.version}.", form.checked.problems)
        return redirect("production", world=world.name, pk=pk)
    lines = Production.objects.filter(grammar__world=world, nonterminal=row.nonterminal)
    context = {
        "row": row,
        "form": form,
        "checked": form.checked or check_production(ProductionEdit.of_stored(row)),
        "lines": lines.exclude(pk=row.pk),
        "query": f"?production={row.pk}",
        **_completion(world, row.source),
    }
    return render(request, "annotations/production.html", context)


@world_view(Duty.ANNOTATE, READ_AND_WRITE)
def production_new(request: HttpRequest, world: World) -> HttpResponse:
    """Add a line to the grammar."""
    if not has_grammar(world):
        return render(request, "annotations/production_needs_grammar.html")
    asked = {name: request.GET.get(name, "") for name in ("nonterminal", "source")}
    form = ProductionForm(world, None, posted(request), initial=asked)
    if request.method == "POST" and form.is_valid():
        row = add(unsaved_production(world, form), request.user, form.cleaned_data["once"])
        tell_saved(request, "Added.", form.checked.problems)
        return redirect("production", world=world.name, pk=row.pk)
    context = {
        "form": form,
        "checked": form.checked,
        **_completion(world, asked["source"] or sources_of(world)[0]),
    }
    return render(request, "annotations/production.html", context)


@world_view(Duty.ANNOTATE, WRITE)
def production_check(request: HttpRequest, world: World) -> JsonResponse:
    """Answer the editor, which asks while somebody types."""
    edit = _read_typed(request, world)
    return JsonResponse(assist_production(edit) if edit else {"problems": [], "slots": []})


@world_view(Duty.ANNOTATE, WRITE)
def production_preview(request: HttpRequest, world: World) -> HttpResponse:
    """Show what the typed production becomes, and what saving it would do."""
    edit = _read_typed(request, world)
    context: dict[str, Any] = {"checked": check_production(edit) if edit else None}
    if edit and not context["checked"].has_errors:
        context["expected"] = consequences_of_production(edit)
        context["groups"] = groups_of(context["expected"])
    return render(request, "annotations/_production_preview.html", context)


def _read_typed(request: HttpRequest, world: World) -> ProductionEdit | None:
    """Return the production as it is typed; None while a field is empty or not valid."""
    row = _read_stored(request, world)
    form = ProductionForm(world, row, request.POST, initial=initial_values(row) if row else {})
    form.is_valid()
    names = ("source", "nonterminal", "expansion")
    values = [form.cleaned_data.get(name) or form[name].value() or "" for name in names]
    if not values[2].strip() or values[0] not in dict(form.fields["source"].choices):
        return None
    if len(values[2]) > form.fields["expansion"].max_length or "\0" in "".join(values):
        return None
    if "nonterminal" in form.errors:
        return None
    return ProductionEdit(world, *values, row)


def _read_stored(request: HttpRequest, world: World) -> Production | None:
    """Return the row that ``production`` names. Raises Http404 where the world has none of that key."""
    key = request.GET.get("production", "")
    if not key:
        return None
    row = Production.objects.filter(grammar__world=world, pk=number_in(key) or 0).first()
    if row is None:
        raise Http404("No such production.")
    return row


def _check_url(world: World, row: Editable) -> str:
    return f"{reverse('production_check', kwargs={'world': world.name})}?production={row.pk}"


def _completion(world: World, source: str) -> dict[str, Any]:
    """Return the task category whose nonterminals the editor offers."""
    edit = ProductionEdit(world, source, "", "")
    return {"category": next(edit.categories(), None)}


def unsaved_production(world: World, form: ProductionForm) -> Production:
    """Return the production that a valid form describes."""
    source = form.cleaned_data["source"]
    return Production(
        grammar=world.grammar,
        source=source,
        nonterminal=form.cleaned_data["nonterminal"],
        expansion=form.cleaned_data["expansion"],
        task_category=own_category(world.grammar.task_categories.all(), source),
    )


def initial_values(row: Editable) -> dict[str, Any]:
    """Return what the fields of the form show for ``row``."""
    names = ("nonterminal", "expansion", "source", "version")
    return {name: getattr(row, name) for name in names}
