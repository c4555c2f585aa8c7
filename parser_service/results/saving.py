"""Verb: save, rename and delete slices."""

from __future__ import annotations

from django.db import IntegrityError, transaction

from annotations.language.texts import LanguageError
from annotations.models import User, World
from parser_service.models import Slice
from parser_service.models.reviews import LONGEST_SLICE_NAME
from parser_service.results.selecting import slice_query


def save_slice(world: World, name: str, query: str, by: User | None = None) -> Slice:
    """Store the slice that ``query`` chooses as ``name``.

    Raises:
        LanguageError: the name is empty, too long or taken, or the query chooses every prediction.
    """
    name = require_name(name)
    written = slice_query(world, query)
    if not written:
        raise LanguageError(
            "this slice would be every prediction", hint="set at least one filter first"
        )
    try:
        with transaction.atomic():
            return Slice.objects.create(world=world, name=name, query=written, created_by=by)
    except IntegrityError:
        raise _name_taken(name) from None


def rename_slice(saved: Slice, name: str) -> None:
    """Give a slice another name; its address stays. Raises LanguageError for a name that cannot be had."""
    saved.name = require_name(name)
    try:
        with transaction.atomic():
            saved.save(update_fields=["name"])
    except IntegrityError:
        raise _name_taken(name) from None


def delete_slice(saved: Slice) -> None:
    """Delete a slice. Error categories that it proposed stay, without it."""
    saved.delete()


def require_name(name: str) -> str:
    """Return a name without the spaces around it. Raises LanguageError where it is empty or too long."""
    name = " ".join(name.replace("\0", "").split())
    if not name:
        raise LanguageError("a slice needs a name", hint="write what its utterances have in common")
    if len(name) > LONGEST_SLICE_NAME:
        raise LanguageError(f"the name is longer than {LONGEST_SLICE_NAME} characters")
    return name


def _name_taken(name: str) -> LanguageError:
    return LanguageError(f"there is a slice “{name}” already", hint="choose another name")
