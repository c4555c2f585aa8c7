"""The recipes of a world: listed, edited with an example beside them, and replaced as a whole."""

from __future__ import annotations

from typing import Any

from django.contrib import messages
from django.http import HttpResponse
from django.shortcuts import redirect, render
from django.urls import reverse

from annotations.editing.recipe_books import (
    proposals_for,
    replace_book,
    shipped_book_of,
    take_proposals,
    version_of,
)
from annotations.generation.recipe_check import problems_by_row
from annotations.language.plans import read_primitive, read_recipe, shipped_books
from annotations.language.texts import Problem, Refusal, say_count
from annotations.models import Duty, World
from annotations.people.access import WRITE, WorldRequest, world_view
from annotations.rows.from_rows import recipe_book_of
from annotations.web.description.recipe_forms import (
    RecipeBookForm,
)
from annotations.web.editing.undo import say_with_undo


@world_view(Duty.VIEW)
def recipes(request: WorldRequest, world: World) -> HttpResponse:
    """List recipes and primitives, with what is wrong with them."""
    problems = problems_by_row(world)
    shipped = shipped_book_of(world)
    own_recipes: list[Any] = [
        (row, read_recipe(row.text), problems.get(("recipe", row.pk), []))
        for row in world.recipes.all()
    ]
    own_primitives: list[Any] = [
        (row, read_primitive(row.text), problems.get(("primitive", row.pk), []))
        for row in world.primitives.all()
    ]
    book, proposed = recipe_book_of(world), proposals_for(world)
    context: dict[str, Any] = {
        "recipes": own_recipes or [_shipped(each) for each in book.recipes],
        "primitives": own_primitives
        if own_recipes
        else [_shipped(each) for each in book.primitives],
        "has_own": bool(own_recipes),
        "shipped": shipped,
        # A world without rows may copy the book that it uses already.
        "offered": [
            each for each in shipped_books().values() if each != shipped or not own_recipes
        ],
        "version": version_of(world),
        "proposed": [
            (each, [proposed.primitive(call.primitive) for call in each.calls])
            for each in proposed.recipes
        ],
    }
    return render(request, "annotations/description/recipes.html", context)


@world_view(Duty.ANNOTATE, WRITE, does="replace the recipes")
def recipe_book(request: WorldRequest, world: World) -> HttpResponse:
    """Replace the whole book; a button of the next page brings the old one back."""
    form = RecipeBookForm(request.POST)
    if not form.is_valid():
        messages.error(request, str(next(iter(form.errors.values()))[0]))
        return redirect("recipes", world=world.name)
    before = _rows_of(world)
    try:
        replace_book(world, form.book, request.user, form.cleaned_data["version"])
    except Refusal as error:
        messages.error(request, f"Not replaced. {error.message}")
    else:
        name = form.cleaned_data["shipped"]
        sentence = (
            f"The recipes are now “{shipped_books()[name].title}”."
            if name
            else "The recipes are as they were."
        )
        _say_with_undo(request, world, sentence, before)
    return redirect("recipes", world=world.name)


@world_view(Duty.ANNOTATE, WRITE, does="take proposed recipes")
def recipes_proposed(request: WorldRequest, world: World) -> HttpResponse:
    """Add the proposed recipes of an action, or of all; a button of the next page takes them away again."""
    before = _rows_of(world)
    action = request.POST.get("action")
    added = take_proposals(world, request.user, action and [action])
    if added.recipes:
        _say_with_undo(request, world, f"Added {say_count(len(added.recipes), 'recipe')}.", before)
    else:
        messages.error(request, "Nothing is proposed there any more.")
    return redirect("recipes", world=world.name)


def _rows_of(world: World) -> dict[str, str]:
    """Return the rows of the book as the form of a whole book takes them."""
    return {
        "primitives": "\n".join(world.primitives.values_list("text", flat=True)),
        "recipes": "\n".join(world.recipes.values_list("text", flat=True)),
    }


def _say_with_undo(
    request: WorldRequest, world: World, sentence: str, before: dict[str, str]
) -> None:
    here = reverse("recipe_book", kwargs={"world": world.name})
    say_with_undo(request, sentence, here, **before, version=version_of(world))


def _shipped(value: Any) -> tuple[None, Any, list[Problem]]:
    """Return what the list shows of a value of a shipped book: it has no row."""
    return None, value, []
