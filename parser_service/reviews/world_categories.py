"""Verbs: give a world its error categories; add, change, order and delete them."""

from __future__ import annotations

from http import HTTPStatus

from django.db import transaction
from django.db.models import Max
from django.utils.text import slugify

from annotations.language.texts import Refusal
from annotations.models import World
from parser_service.analysis.error_categories import DESCRIPTIONS, NAMES
from parser_service.models import ErrorCategory, Review, Slice

LONGEST_CODE = 40


def ensure_categories(world: World) -> dict[str, ErrorCategory]:
    """Return the error categories of ``world`` by code, in their order.

    A world without any gets those of ``parser_service.analysis.error_categories``. Categories that an
    admin has deleted do not come back while there are others.
    """
    rows = world.error_categories.select_related("slice")
    found = {row.code: row for row in rows}
    if not found:
        made = [
            ErrorCategory(
                world=world,
                code=code.value,
                name=NAMES[code],
                description=DESCRIPTIONS[code],
                position=position,
            )
            for position, code in enumerate(NAMES)
        ]
        # Whoever does the same at this moment makes the same rows.
        ErrorCategory.objects.bulk_create(made, ignore_conflicts=True)
        found = {row.code: row for row in rows.all()}
    return found


def add_category(
    world: World, name: str, description: str = "", of_slice: Slice | None = None
) -> ErrorCategory:
    """Add an error category behind the others.

    Raises Refusal where there is one of that name.
    """
    with transaction.atomic():
        World.objects.hold().get(pk=world.pk)
        _require_free(world, name)
        last = world.error_categories.aggregate(last=Max("position"))["last"]
        return ErrorCategory.objects.create(
            world=world,
            code=_free_code(world, name),
            name=name,
            description=description,
            position=0 if last is None else last + 1,
            slice=of_slice,
        )


def change_category(
    category: ErrorCategory, name: str, description: str, of_slice: Slice | None
) -> None:
    """Rename a category, describe it, or let a slice propose it. Its code stays: the machine proposes by it.

    Raises Refusal where another one has the name.
    """
    with transaction.atomic():
        World.objects.hold().get(pk=category.world_id)
        _require_free(category.world, name, but=category)
        category.name, category.description, category.slice = name, description, of_slice
        category.save(update_fields=["name", "description", "slice"])


def move_category(category: ErrorCategory, step: int) -> None:
    """Exchange a category with the one before (-1) or after (1); the first and the last stay."""
    with transaction.atomic():
        World.objects.hold().get(pk=category.world_id)
        rows = list(category.world.error_categories.all())
        at = next(place for place, row in enumerate(rows) if row.pk == category.pk)
        to = min(max(at + step, 0), len(rows) - 1)
        rows.insert(to, rows.pop(at))
        for position, row in enumerate(rows):
            row.position = position
        ErrorCategory.objects.bulk_update(rows, ["position"])


def delete_category(category: ErrorCategory, move_to: ErrorCategory | None) -> int:
    """Delete a category and give its reviews to ``move_to``. Return how many there were.

    Raises Refusal where it has reviews and none is named, or it is the last one.
    """
    with transaction.atomic():
        World.objects.hold().get(pk=category.world_id)
        if not category.world.error_categories.exclude(pk=category.pk).exists():
            raise Refusal(
                "A world keeps at least one error category.",
                "last_error_category",
                HTTPStatus.CONFLICT,
            )
        reviews = Review.objects.filter(category=category)
        count = reviews.count()
        if count and (move_to is None or move_to.pk == category.pk):
            raise Refusal(
                f"Say which category its {count:,} reviews are moved to.",
                "reviews_need_category",
                HTTPStatus.CONFLICT,
            )
        if move_to is not None and move_to.world_id != category.world_id:
            raise Refusal(
                "Its reviews cannot be moved to a category of another world.",
                "category_of_another_world",
                HTTPStatus.CONFLICT,
            )
        reviews.update(category=move_to)
        category.delete()
    return count


def _require_free(world: World, name: str, but: ErrorCategory | None = None) -> None:
    others = world.error_categories.all()
    if but is not None:
        others = others.exclude(pk=but.pk)
    # Compared here: SQLite knows the case of ASCII letters alone, and PostgreSQL refuses what it let in.
    if name.lower() in map(str.lower, others.values_list("name", flat=True)):
        raise Refusal(
            f"There is an error category “{name}” already. Choose another name.",
            "category_name_taken",
            HTTPStatus.CONFLICT,
        )


def _free_code(world: World, name: str) -> str:
    """Return a code made of the name that no category of the world has."""
    taken = set(world.error_categories.values_list("code", flat=True))
    base = slugify(name).replace("-", "_")[: LONGEST_CODE - 4] or "category"
    numbered = (base if number == 1 else f"{base}_{number}" for number in range(1, len(taken) + 2))
    return next(code for code in numbered if code not in taken)
