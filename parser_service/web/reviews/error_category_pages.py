"""The error categories of a world: how often each is given, and what admins change about them."""

from __future__ import annotations

from django.contrib import messages
from django.db.models import Exists, OuterRef
from django.http import HttpResponse
from django.shortcuts import get_object_or_404, redirect, render

from annotations.language.texts import Refusal
from annotations.models import Duty, World
from annotations.people.access import READ_AND_WRITE, WRITE, PageRequest, WorldRequest, world_view
from annotations.showing.paging import number_in
from annotations.web.forms import posted
from parser_service.models import ErrorCategory, Review
from parser_service.reviews.category_counts import agreement_of_reviewers, count_categories
from parser_service.reviews.world_categories import (
    add_category,
    change_category,
    delete_category,
    ensure_categories,
    move_category,
)
from parser_service.serving.default_runs import opening_run
from parser_service.web.reviews.error_category_forms import CategoryForm, DeletionForm

STEPS = {"up": -1, "down": 1}


@world_view(Duty.VIEW, READ_AND_WRITE, write_duty=Duty.MANAGE, does="add an error category")
def error_categories(request: WorldRequest, world: World) -> HttpResponse:
    """List the error categories with their counts, of all runs or of the one that the address names."""
    form = CategoryForm(world, posted(request))
    if request.method == "POST" and form.is_valid():
        values = form.cleaned_data
        try:
            added = add_category(world, values["name"], values["description"], values["slice"])
        except Refusal as error:
            form.add_error("name", error.message)
        else:
            messages.success(request, f"Added: {added}.")
            return redirect("error_categories", world=world.name)
    status = 422 if form.errors else 200
    categories = list(ensure_categories(world).values())
    runs = world.runs.filter(Exists(Review.objects.filter(run=OuterRef("pk"))))
    run = runs.filter(pk=number_in(request.GET.get("run", ""))).first()
    opening = opening_run(world)
    context = {
        "form": form,
        "counts": count_categories(world, categories, run),
        "runs": runs,
        "run": run,
        "shown": run or (opening if opening in runs else runs.first()),  # whose errors they lead to
        "agreement": agreement_of_reviewers(world),
    }
    return render(request, "parser_service/reviews/error_categories.html", context, status=status)


@world_view(Duty.VIEW, READ_AND_WRITE, write_duty=Duty.MANAGE, does="change an error category")
def error_category(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show one category; an admin renames it, describes it or lets a slice propose it."""
    category = get_object_or_404(world.error_categories.select_related("slice"), pk=pk)
    form = CategoryForm(world, posted(request), instance=category)
    if request.method == "POST" and form.is_valid():
        values = form.cleaned_data
        stored = get_object_or_404(world.error_categories, pk=pk)
        try:
            change_category(stored, values["name"], values["description"], values["slice"])
        except Refusal as error:
            form.add_error("name", error.message)
        else:
            messages.success(request, "Saved.")
            return redirect("error_categories", world=world.name)
    return _category_page(request, category, form, DeletionForm(category))


def _category_page(
    request: PageRequest, category: ErrorCategory, form: CategoryForm, deletion: DeletionForm
) -> HttpResponse:
    name = ErrorCategory.objects.values_list("name", flat=True).get(pk=category.pk)
    context = {
        "category": category,
        "name": name,
        "form": form,
        "deletion": deletion,
        "reviews": Review.objects.filter(category=category).count(),
    }
    status = 422 if form.errors or deletion.errors else 200
    return render(request, "parser_service/reviews/error_category.html", context, status=status)


@world_view(Duty.MANAGE, WRITE, does="move an error category")
def error_category_move(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Put a category one place up or down; its key on the review page follows."""
    category = get_object_or_404(world.error_categories, pk=pk)
    move_category(category, STEPS.get(request.POST.get("step", ""), 0))
    return redirect("error_categories", world=world.name)


@world_view(Duty.MANAGE, WRITE, does="delete an error category")
def error_category_delete(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Delete a category and move its reviews to another one."""
    category = get_object_or_404(world.error_categories.select_related("world"), pk=pk)
    deletion = DeletionForm(category, request.POST)
    if deletion.is_valid():
        try:
            moved = delete_category(category, deletion.cleaned_data["move_to"])
        except Refusal as error:
            deletion.add_error("move_to", error.message)
        else:
            said = f" Its {moved:,} reviews were moved." if moved else ""
            messages.success(request, f"Deleted: {category.name}.{said}")
            return redirect("error_categories", world=world.name)
    return _category_page(request, category, CategoryForm(world, instance=category), deletion)
