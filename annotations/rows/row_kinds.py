"""The kinds of rows that people edit: what pages call them and where they are shown."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from django.db import models
from django.http import Http404

from annotations.models import (
    Duty,
    Editable,
    Entity,
    EntityClass,
    Guidelines,
    Paraphrase,
    Predicate,
    Primitive,
    Production,
    Recipe,
    SemanticTemplate,
    TaskCategory,
    Utterance,
    World,
)
from annotations.rows.history import DELETED, history_of

# The fields that hold a logical form; their differences are those of forms, not of words.
FORM_FIELDS = frozenset({"form", "logical_form", "grounded_form"})
LABELS = {"form": "Logical form", "gloss": "English", "spans": "Entities named, from and to"}


@dataclass(frozen=True, slots=True)
class EditableKind:
    """``name`` stands in addresses; ``page`` and ``list_page`` are names of routes.

    ``page`` is that of one row, with its key; empty where rows have no page of their own. People with
    ``write_duty`` edit and restore them. ``called`` is what pages call one, where that is not its name.
    """

    name: str
    model: type[Editable]
    plural: str
    list_page: str
    page: str = ""
    write_duty: Duty = Duty.ANNOTATE
    is_deletable: bool = True
    called: str = ""

    @property
    def singular(self) -> str:
        """What pages call one."""
        return self.called or self.name

    def rows_of(self, world: World) -> models.QuerySet[Editable]:
        return self.model._default_manager.filter(**{self.model.world_path: world})

    def entries_of(self, world: World) -> models.QuerySet[Any]:
        """Return the history of all rows of this kind, newest entry first."""
        entries = history_of(self.model).filter(**{self.model.world_path: world})
        newest_first: models.QuerySet[Any] = entries.select_related("history_user").order_by(
            "-history_id"
        )
        return newest_first

    def deletions_in(self, world: World) -> models.QuerySet[Any]:
        """Return the last history entries of the rows that are deleted, the latest deletion first."""
        entries = self.entries_of(world)
        later = history_of(self.model).filter(
            id=models.OuterRef("id"), history_id__gt=models.OuterRef("history_id")
        )
        deletions: models.QuerySet[Any] = entries.filter(
            ~models.Exists(later), history_type=DELETED
        )
        return deletions

    def row_or_last_known(self, world: World, pk: int) -> tuple[Any, bool]:
        """Return the row and whether it is there; one that was deleted is as it was last.

        Raises Http404 where the world never had such a row.
        """
        if row := self.rows_of(world).filter(pk=pk).first():
            return row, True
        if entry := self.entries_of(world).filter(id=pk).first():
            return entry.instance, False
        raise Http404(f"There is no such {self.name}.")


KINDS = {
    kind.name: kind
    for kind in (
        EditableKind("template", SemanticTemplate, "templates", "templates", "template"),
        EditableKind("production", Production, "productions", "grammar", "production"),
        EditableKind(
            *("task_category", TaskCategory, "task categories", "task_categories", "task_category"),
            called="task category",
        ),
        EditableKind("entity", Entity, "entities", "ontology", "entity"),
        EditableKind(
            *("entity_class", EntityClass, "classes", "entity_classes", "entity_class"),
            called="class",
        ),
        EditableKind("predicate", Predicate, "predicates", "predicates", "predicate"),
        EditableKind("recipe", Recipe, "recipes", "recipes", "recipe"),
        EditableKind("primitive", Primitive, "primitives", "recipes", "primitive"),
        EditableKind("paraphrase", Paraphrase, "paraphrases", "paraphrases", "paraphrase"),
        EditableKind("utterance", Utterance, "utterances", "utterances", "utterance"),
        EditableKind(
            *("guidelines", Guidelines, "guidelines", "guidelines"),
            write_duty=Duty.MANAGE,
            is_deletable=False,
        ),
    )
}


def kind_of(row: Editable) -> EditableKind:
    """Return the kind of ``row``."""
    return kind_of_model(type(row))


def kind_of_model(model: type[Editable]) -> EditableKind:
    """Return the kind of the rows of ``model``."""
    return next(kind for kind in KINDS.values() if kind.model is model)


def label_of(field: str) -> str:
    """Return what pages call a field."""
    return LABELS.get(field) or field.replace("_", " ").capitalize()


def as_text(value: Any) -> str:
    """Write the value of a field as people read it: lists a line each, pairs as ``name: value`` by name.

    PostgreSQL does not keep the order in which pairs were stored.
    """
    if isinstance(value, dict):
        return "\n".join(f"{name}: {each}" for name, each in sorted(value.items()))
    if isinstance(value, list | tuple):
        return "\n".join(", ".join(map(str, v)) if isinstance(v, list) else str(v) for v in value)
    return "" if value is None else str(value)
