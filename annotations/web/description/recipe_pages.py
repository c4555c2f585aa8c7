"""The recipes of a world: listed, edited with an example beside them, and replaced as a whole."""

from __future__ import annotations

from typing import Any

from django.contrib import messages
from django.http import HttpResponse
from django.shortcuts import redirect, render
from django.urls import reverse

from annotations.editing.recipe_books import replace_book, shipped_book_of, version_of
from annotations.generation.recipe_check import problems_by_row
from annotations.language.plans import default_book, read_primitive, read_recipe, shipped_books
from annotations.language.texts import Problem, Refusal
from annotations.models import Duty, World
from annotations.people.access import WRITE, WorldRequest, world_view
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
    book = default_book()
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
    }
    return render(request, "annotations/description/recipes.html", context)


@world_view(Duty.ANNOTATE, WRITE, does="replace the recipes")
def recipe_book(request: WorldRequest, world: World) -> HttpResponse:
    """Replace the whole book; a button of the next page brings the old one back."""
    form = RecipeBookForm(request.POST)
    if not form.is_valid():
        messages.error(request, str(next(iter(form.errors.values()))[0]))
        return redirect("recipes", world=world.name)
    before = {
        "primitives": "\n".join(world.primitives.values_list("text", flat=True)),
        "recipes": "\n".join(world.recipes.values_list("text", flat=True)),
    }
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
        here = reverse("recipe_book", kwargs={"world": world.name})
        say_with_undo(request, sentence, here, **before, version=version_of(world))
    return redirect("recipes", world=world.name)


def _shipped(value: Any) -> tuple[None, Any, list[Problem]]:
    """Return what the list shows of a value of a shipped book: it has no row."""
    return None, value, []
