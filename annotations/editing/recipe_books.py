"""Verbs: give a world another recipe book as a whole, such as one that ships, or the recipes that are proposed."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from hashlib import sha256
from http import HTTPStatus
from typing import Any

from django.db import transaction
from django.db.models import QuerySet

from annotations.generation.recipe_check import RowModel
from annotations.language.plans import (
    DEFAULT_BOOK,
    RecipeBook,
    ShippedBook,
    propose,
    shipped_books,
)
from annotations.language.texts import Refusal
from annotations.models import Primitive, Recipe, User, World
from annotations.rows.from_rows import predicates_of, recipe_book_of
from annotations.rows.history import ADDED, CHANGED, DELETED, keep, keep_first


def version_of(world: World) -> str:
    """Return a text that changes with every change of the recipe book of ``world``."""
    rows = [
        (model.__name__, *row)
        for model in (Primitive, Recipe)
        for row in model.objects.filter(world=world).values_list("pk", "version")
    ]
    return sha256(repr(rows).encode()).hexdigest()[:20]


def shipped_book_of(world: World) -> ShippedBook | None:
    """Return the shipped book that ``world`` has, unchanged; None where it has made its own of it."""
    stored = {
        model: set(model.objects.filter(world=world).values_list("text", flat=True))
        for model in (Primitive, Recipe)
    }
    if not stored[Recipe]:
        return shipped_books()[DEFAULT_BOOK]
    return next(
        (
            each
            for each in shipped_books().values()
            if stored[Primitive] == set(map(str, each.book.primitives))
            and stored[Recipe] == set(map(str, each.book.recipes))
        ),
        None,
    )


def replace_book(world: World, book: RecipeBook, by: User, version: str = "") -> None:
    """Make ``book`` the recipe book of ``world``: change the rows that differ, add and delete the others.

    Primitives are known by their names and recipes by their left sides, so that each keeps its history.

    Args:
        book: one without errors.
        version: what ``version_of`` said when ``by`` read the book; empty for any.

    Raises:
        Refusal: the book has changed since.
        LanguageError: a row of the book cannot be stored.
    """
    primitives = [Primitive.columns_of(str(each)) for each in book.primitives]
    recipes = [Recipe.columns_of(str(each)) for each in book.recipes]
    with transaction.atomic():
        world = World.objects.hold().get(pk=world.pk)
        if version and version != version_of(world):
            raise Refusal(
                "Somebody has changed the recipes meanwhile. Look at them again.",
                "recipes_changed_meanwhile",
                HTTPStatus.CONFLICT,
            )
        _replace(world, Primitive, "name", primitives, by)
        _replace(world, Recipe, "left", recipes, by)


def proposals_for(world: World) -> RecipeBook:
    """Return what is proposed for the actions of ``world`` that no recipe covers."""
    return propose(recipe_book_of(world), predicates_of(world))


def take_proposals(world: World, by: User, actions: Collection[str] | None = None) -> RecipeBook:
    """Add the recipes that are proposed to those of ``world``, with their primitives; return what was added.

    ``actions`` limits them to those of some actions. A world without rows of its own gets those of the book that it
    uses first.
    """
    with transaction.atomic():
        world = World.objects.hold().get(pk=world.pk)
        book, proposed = recipe_book_of(world), proposals_for(world)
        recipes = tuple(
            each for each in proposed.recipes if actions is None or each.pattern.action in actions
        )
        called = {call.primitive for each in recipes for call in each.calls}
        primitives = tuple(each for each in proposed.primitives if each.name in called)
        if recipes:
            whole = RecipeBook((*book.primitives, *primitives), (*book.recipes, *recipes))
            replace_book(world, whole, by)
    return RecipeBook(primitives, recipes)


def _replace(
    world: World, model: RowModel, key: str, wanted: Sequence[Mapping[str, Any]], by: User
) -> None:
    """Make the rows of a kind those that are wanted; ``key`` is the column that says which is which."""
    rows: QuerySet[Any] = model._default_manager.filter(world=world)
    stored = {getattr(row, key): row for row in rows}
    names = {values[key] for values in wanted}
    gone = [row for name, row in stored.items() if name not in names]
    keep_first(model, [row.pk for row in gone])
    keep(gone, DELETED, by)
    rows.filter(pk__in=[row.pk for row in gone]).delete()
    added: list[Any] = []
    changed: list[Any] = []
    kept: list[Any] = []
    for position, values in enumerate(wanted):
        row = stored.get(values[key])
        if row is None:
            added.append(model(world=world, position=position, **values))
            continue
        row.position = position
        kept.append(row)
        if row.text != values["text"]:
            row.text = values["text"]
            row.version += 1
            changed.append(row)
    keep_first(model, [row.pk for row in changed])
    model._default_manager.bulk_update(kept, ["text", "position", "version"])
    keep(changed, CHANGED, by)
    keep(model._default_manager.bulk_create(added), ADDED, by)
