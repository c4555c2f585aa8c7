"""The recipes of a world: listed, edited with an example beside them, and replaced as a whole."""

from __future__ import annotations

from typing import Any

from django.contrib import messages
from django.core.exceptions import ValidationError
from django.http import Http404, HttpResponse
from django.shortcuts import redirect, render
from django.urls import reverse

from annotations.editing.edits import Overtaken, add
from annotations.editing.recipe_books import replace_book, shipped_book_of, version_of
from annotations.generation.recipe_check import (
    BookRow,
    CheckedRow,
    RowModel,
    problems_by_row,
    try_row,
)
from annotations.language.plans import default_book, read_primitive, read_recipe, shipped_books
from annotations.language.texts import Problem, Refusal
from annotations.models import Duty, Primitive, Recipe, World
from annotations.people.access import READ_AND_WRITE, WRITE, WorldRequest, world_view
from annotations.rows.row_kinds import KINDS
from annotations.showing.paging import number_in
from annotations.web.description.recipe_forms import BookRowForm, RecipeBookForm, initial_values
from annotations.web.editing.merge_pages import merge_page, save_edit
from annotations.web.editing.undo import say_with_undo
from annotations.web.forms import posted

MODELS: dict[str, RowModel] = {"recipe": Recipe, "primitive": Primitive}


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


@world_view(Duty.ANNOTATE, WRITE)
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


@world_view(Duty.VIEW, READ_AND_WRITE, write_duty=Duty.ANNOTATE)
def recipe(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show a recipe with an example. Annotators change it."""
    return _row_page(request, world, "recipe", pk)


@world_view(Duty.VIEW, READ_AND_WRITE, write_duty=Duty.ANNOTATE)
def primitive(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show a primitive with an example. Annotators change it."""
    return _row_page(request, world, "primitive", pk)


@world_view(Duty.ANNOTATE, READ_AND_WRITE)
def recipe_new(request: WorldRequest, world: World) -> HttpResponse:
    """Add a recipe."""
    return _new_page(request, world, "recipe")


@world_view(Duty.ANNOTATE, READ_AND_WRITE)
def primitive_new(request: WorldRequest, world: World) -> HttpResponse:
    """Add a primitive."""
    return _new_page(request, world, "primitive")


@world_view(Duty.ANNOTATE, WRITE)
def recipe_preview(request: WorldRequest, world: World) -> HttpResponse:
    """Say what is wrong with the typed recipe, and what the robot does by it."""
    return _preview(request, world, "recipe")


@world_view(Duty.ANNOTATE, WRITE)
def primitive_preview(request: WorldRequest, world: World) -> HttpResponse:
    """Say what is wrong with the typed primitive, and what the robot does with it."""
    return _preview(request, world, "primitive")


def _row_page(request: WorldRequest, world: World, kind: str, pk: int) -> HttpResponse:
    row, is_there = KINDS[kind].row_or_last_known(world, pk)
    if not is_there and request.method != "POST":
        return redirect("history", world=world.name, kind=kind, pk=pk)
    model = MODELS[kind]
    form = BookRowForm(world, model, row, posted(request), initial=initial_values(row))
    if request.method == "POST" and form.is_valid():
        try:
            row = save_edit(request, row, form, form.values)
        except Overtaken as clash:
            return merge_page(request, row, form, clash, initial_values)
        except ValidationError as error:
            form.add_error("text", error.messages)
        else:
            messages.success(request, f"Saved as version {row.version}.")
            return redirect(kind, world=world.name, pk=pk)
    checked = try_row(world, model, row.text, row if is_there else None)
    return _render(request, kind, form, row, checked)


def _new_page(request: WorldRequest, world: World, kind: str) -> HttpResponse:
    model = MODELS[kind]
    form = BookRowForm(
        world, model, None, posted(request), initial={"text": request.GET.get("text", "")}
    )
    if request.method == "POST" and form.is_valid():
        try:
            row = add(model(world=world, **form.values), request.user, form.cleaned_data["once"])
        except ValidationError as error:
            form.add_error("text", error.messages)
        else:
            messages.success(request, f"Added {_name_of(row)}.")
            return redirect(kind, world=world.name, pk=row.pk)
    return _render(request, kind, form, None, None)


def _render(
    request: WorldRequest,
    kind: str,
    form: BookRowForm,
    row: BookRow | None,
    checked: CheckedRow | None,
) -> HttpResponse:
    context = {
        "kind": kind,
        "row": row,
        "name": _name_of(row) if row else "",
        "form": form,
        "checked": checked,
        "text": row.text if row else "",
        "preview": f"{kind}_preview",
        "query": f"?row={row.pk}" if row else "",
    }
    return render(request, "annotations/description/recipe.html", context)


def _preview(request: WorldRequest, world: World, kind: str) -> HttpResponse:
    key = request.GET.get("row", "")
    row = KINDS[kind].rows_of(world).filter(pk=number_in(key)).first()
    if key and row is None:
        raise Http404(f"No such {kind}.")
    text = request.POST.get("text", "").replace("\0", "").replace("\r\n", "\n").replace("\n", " ")
    context: dict[str, Any] = {"text": text}
    if text.strip():
        chosen = request.POST.get("example", "")
        context["checked"] = try_row(world, MODELS[kind], text, row, chosen)  # type: ignore[arg-type]  # of that kind
    return render(request, "annotations/description/_recipe_preview.html", context)


def _shipped(value: Any) -> tuple[None, Any, list[Problem]]:
    """Return what the list shows of a value of a shipped book: it has no row."""
    return None, value, []


def _name_of(row: BookRow) -> str:
    return row.name if isinstance(row, Primitive) else str(read_recipe(row.text).pattern)
