"""The kinds of rows by their names in URLs, and the verbs that only some kinds have."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from django.http import Http404

from annotations.editing.deletion_of_unused import delete_class, delete_primitive
from annotations.editing.task_categories import delete_category
from annotations.labelling.utterance_deletion import delete_utterance
from annotations.labelling.utterance_deletion import restore as restore_with_answers
from annotations.models import (
    Editable,
    EntityClass,
    Primitive,
    TaskCategory,
    User,
    Utterance,
)
from annotations.rows.row_kinds import KINDS, EditableKind

RESTORING: dict[type[Editable], Callable[[Any, User], Any]] = {
    Utterance: restore_with_answers
}  # what more than the row itself is restored with

DELETING: dict[type[Editable], Callable[[Any, User, int], Any]] = {
    Utterance: delete_utterance,
    EntityClass: delete_class,
    Primitive: delete_primitive,
    TaskCategory: delete_category,
}  # what keeps more than its history, or may have to stay


def kind_named(name: str) -> EditableKind:
    """Return the kind of that name. Raises Http404."""
    if name not in KINDS:
        raise Http404("There is no such kind of row.")
    return KINDS[name]
