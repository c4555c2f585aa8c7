"""Frozen splits, on which parsers are trained and tested, and their examples."""

from __future__ import annotations

from typing import Any

from django.contrib import messages
from django.http import HttpResponse
from django.shortcuts import get_object_or_404, redirect, render

from annotations.generation.freezing import free_name
from annotations.generation.freezing_job import start_freezing, start_preview, start_renewal
from annotations.generation.renewing import changes_since, is_from_import, last_of
from annotations.generation.split_statistics import figures_of, near_duplicates_of
from annotations.labelling.label_changes import examples_before
from annotations.language.texts import LanguageError
from annotations.models import Duty, Example, Job, Split, World
from annotations.people.access import READ_AND_WRITE, WRITE, WorldRequest, world_view
from annotations.people.allowances import may_take_long
from annotations.rows.occurrences import command_of_example, logical_form_of, paraphrase_of_example
from annotations.showing.listing import Listing, Sort, render_list
from annotations.showing.own_entities import OwnEntities
from annotations.web.corpus.split_filters import (
    MOST_CHANGES,
    MOST_SHOWN,
    ExampleFilters,
    SplitFilters,
)
from annotations.web.corpus.split_forms import SplitForm
from annotations.web.forms import posted

SORTS = {
    "position": Sort("No.", "id", is_number=True),
    "utterance": Sort("Utterance", "utterance"),
    "category": Sort("Task category", "task_category"),
}
SPLIT_SORTS = {"created": Sort("Frozen", "-created_at"), "name": Sort("Split", "name")}
# Examples that are compared with the corpus of today before the page is shown.
MOST_COMPARED = 500


@world_view(Duty.VIEW)
def splits(request: WorldRequest, world: World) -> HttpResponse:
    """List the splits with the number of their pairs by part and source."""
    listing = Listing(request, SplitFilters, world.splits.select_related("created_by"), SPLIT_SORTS)
    rows = [(row, figures_of(row).counts) for row in listing.rows]
    context = {"listing": listing, "rows": rows}
    return render_list(request, "annotations/corpus/splits.html", context)


@may_take_long
@world_view(Duty.ANNOTATE, READ_AND_WRITE, does="freeze a split")
def split_new(request: WorldRequest, world: World) -> HttpResponse:
    """Show the form that freezes a split; its other button only previews the counts."""
    initial = {"name": free_name(world)}
    form = SplitForm(posted(request), initial=initial)
    context: dict[str, Any] = {"form": form}
    if form.is_bound and form.is_valid():
        try:
            started: Job | Split | dict[str, Any]
            if "freeze" in request.POST:
                name = form.cleaned_data["name"]
                started = start_freezing(world, request.user, name, **form.choice)
            else:
                started = start_preview(world, request.user, **form.choice)
        except LanguageError as error:
            form.add_error(None, str(error))
        else:
            if not isinstance(started, dict):
                return _shown(world, started)
            context["report"] = started
    return render(request, "annotations/corpus/split_new.html", context)


@world_view(Duty.VIEW)
def split(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show one split: its parts, the overlap between them, its examples."""
    row = get_object_or_404(
        Split.objects.select_related("created_by", "follows", "world"), world=world, pk=pk
    )
    newest, figures = last_of(row), figures_of(row)
    context: dict[str, Any] = {
        "split": row,
        "newest": newest if newest != row else None,
        "counts": figures.counts,
        "leakage": figures.leaks,
        "wrong": examples_before(row).count(),
        "listing": Listing(request, ExampleFilters, row.examples.all(), SORTS),
    }
    if newest == row and sum(each.total for each in figures.counts) <= MOST_COMPARED:
        context |= {"is_compared": True, **_changes_of(row)}
    return render_list(request, "annotations/corpus/split.html", context)


@world_view(Duty.VIEW)
def split_changes(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Preview freezing a split anew. The page of a large split loads this part later."""
    row = get_object_or_404(Split.objects.select_related("world", "follows"), world=world, pk=pk)
    context = {"split": row, **_changes_of(row)}
    return render(request, "annotations/corpus/_split_changes.html", context)


def _changes_of(row: Split) -> dict[str, object]:
    """Return what ``_split_changes.html`` shows of a split."""
    try:
        changed: dict[str, object] = {"changes": changes_since(row)}
    except LanguageError as error:
        changed = {"refusal": error.problem}
    return {"most": MOST_CHANGES, "is_from_import": is_from_import(row), **changed}


@may_take_long
@world_view(Duty.ANNOTATE, WRITE, does="freeze a split anew")
def split_renew(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Freeze a split anew from the corpus of today, and show the new one."""
    row = get_object_or_404(Split.objects.select_related("world", "follows"), world=world, pk=pk)
    try:
        started = start_renewal(row, request.user)
    except LanguageError as error:
        messages.error(request, str(error))
        return redirect("split", world=world.name, pk=pk)
    if isinstance(started, Split):
        messages.success(request, f"Frozen anew as {started}. {row} stays as it was.")
    return _shown(world, started)


def _shown(world: World, started: Job | Split) -> HttpResponse:
    """Lead to a split that was just frozen, or to the job that freezes it."""
    if isinstance(started, Job):
        return redirect("job", pk=started.pk)
    return redirect("split", world=world.name, pk=started.pk)


@world_view(Duty.VIEW)
def example(request: WorldRequest, world: World, split: int, pk: int) -> HttpResponse:
    """Show one example of a split, and the command and paraphrase that it was copied from."""
    rows = Example.objects.filter(split__world=world, split=split).select_related("split__world")
    row = get_object_or_404(rows, pk=pk)
    context = {
        "row": row,
        "own": OwnEntities.of_pair(world, row),
        "command": command_of_example(row),
        "paraphrase": paraphrase_of_example(row),
        "logical_form": logical_form_of(world.pk, row.logical_form),
    }
    return render(request, "annotations/corpus/example.html", context)


@world_view(Duty.VIEW)
def near_duplicates(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """List near duplicates of training utterances: a part of the split's page, loaded when opened."""
    row = get_object_or_404(Split.objects.select_related("world"), world=world, pk=pk)
    context: dict[str, object] = {"most": MOST_SHOWN}
    try:
        context["parts"] = [
            (each.leak, each.duplicates[:MOST_SHOWN], len(each.duplicates))
            for each in near_duplicates_of(row)
        ]
    except LanguageError as error:
        context["refusal"] = error.problem
    return render(request, "annotations/corpus/_near_duplicates.html", context)
