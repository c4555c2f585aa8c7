"""Verb: give a world another recipe book as a whole, such as one that ships."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from hashlib import sha256
from typing import Any

from django.db import transaction

from annotations.editing.edits import add, change, delete
from annotations.language.errors import Refusal
from annotations.language.recipes import DEFAULT_BOOK, RecipeBook, ShippedBook, shipped_books
from annotations.models import Primitive, Recipe, User, World


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
        version: what ``version_of`` said when ``by`` read the book; empty for any.

    Raises:
        Refusal: the book has changed since.
        LanguageError: a row of the book cannot be stored.
        ValidationError: two rows of the book are the same.
    """
    with transaction.atomic():
        world = World.objects.select_for_update().get(pk=world.pk)
        if version and version != version_of(world):
            raise Refusal(
                "Somebody has changed the recipes meanwhile. Look at them again.",
                "recipes_changed_meanwhile",
                409,
            )
        primitives = [Primitive.columns_of(str(each)) for each in book.primitives]
        recipes = [Recipe.columns_of(str(each)) for each in book.recipes]
        _replace(world, Primitive, "name", primitives, by)
        _replace(world, Recipe, "left", recipes, by)


def _replace(
    world: World,
    model: type[Primitive | Recipe],
    key: str,
    wanted: Sequence[Mapping[str, Any]],
    by: User,
) -> None:
    stored = {getattr(row, key): row for row in model.objects.filter(world=world)}
    names = {values[key] for values in wanted}
    for name, old in stored.items():
        if name not in names:
            delete(old, by, old.version)
    for position, values in enumerate(wanted):
        row = stored.get(values[key])
        if row is None:
            add(model(world=world, position=position, **values), by)
        elif row.text != values["text"]:
            change(row, values, by, row.version)
    # Where a row stands is no part of its versions.
    for position, values in enumerate(wanted):
        model.objects.filter(world=world, **{key: values[key]}).update(position=position)
