"""Which rows make up a world, and how a row becomes a line of JSON and a row again."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property
from typing import Any

from django.db import models
from django.utils.module_loading import import_string

from annotations.models import (
    Assignment,
    AuditDecision,
    AuditFinding,
    AuditReason,
    Command,
    Comment,
    EarlierText,
    Entity,
    Example,
    Label,
    LogicalForm,
    Paraphrase,
    Predicate,
    Production,
    SemanticTemplate,
    Split,
    StoredProblem,
    TaskCategory,
    Utterance,
    WorkItem,
    WorkShare,
    World,
)
from annotations.worlds.parts import registered_parts

FORMAT, VERSION = "gpsr-workbench-world", 1
WORLD_FIELDS = ("description", "revision", "generated_revision")


@dataclass(frozen=True)
class Table:
    """The rows of one model in one world, as the file ``rows/NAME.jsonl``.

    ``owner`` is the field that leads to the world (through the grammar or ontology where it is one of
    these); it is not written, and empty where the first reference leads there. ``references`` are the
    fields that refer to rows of other tables, or to earlier ones of this table, by
    line number from 0; ``people`` those that refer to accounts, by user name. Where there are
    ``subjects``, the field ``subject`` refers to a row of the table that is named there for the row's
    ``kind``, or to none. ``shapes`` says of each JSON column of another application's table whether a
    value may stand there.
    """

    name: str
    model: type[models.Model]
    owner: str = ""
    references: Mapping[str, str] = field(default_factory=dict)
    people: tuple[str, ...] = ()
    subjects: Mapping[str, str] = field(default_factory=dict)
    shapes: Mapping[str, Callable[[Any], bool]] = field(default_factory=dict)

    @property
    def path(self) -> str:
        return f"rows/{self.name}.jsonl"

    @cached_property
    def columns(self) -> tuple[models.Field, ...]:
        """The fields that are written as they are; derived ones follow from them."""
        apart = {"id", self.owner, *self.references, *self.people}
        apart |= {"subject"} if self.subjects else set()
        return tuple(
            each
            for each in self.model._meta.concrete_fields
            if each.name not in apart
            and not getattr(each, "auto_now_add", False)
            and not getattr(each, "is_derived", False)
        )

    @cached_property
    def world_path(self) -> str:
        """The lookup that leads from a row to its world."""
        if not self.owner:
            return f"{next(iter(self.references))}__world"
        is_direct = self.model._meta.get_field(self.owner).related_model is World
        return self.owner if is_direct else f"{self.owner}__world"


# Rows stand behind those that they refer to.
OUR_TABLES = (
    Table("entities", Entity, "ontology"),
    Table("task_categories", TaskCategory, "grammar"),
    Table("productions", Production, "grammar"),
    Table("predicates", Predicate, "world"),
    Table("templates", SemanticTemplate, "grammar", people=("author",)),
    Table("forms", LogicalForm, "world"),
    Table("commands", Command, "world", {"template": "templates", "logical_form": "forms"}),
    Table("paraphrases", Paraphrase, "world", {"command": "commands"}),
    Table("utterances", Utterance, "world", people=("created_by",)),
    Table("labels", Label, references={"utterance": "utterances"}, people=("annotator",)),
    Table(
        "audit_findings",
        AuditFinding,
        "world",
        {"paraphrase": "paraphrases", "utterance": "utterances"},
    ),
    Table("audit_reasons", AuditReason, references={"finding": "audit_findings"}),
    Table(
        "audit_decisions",
        AuditDecision,
        references={"finding": "audit_findings", "label": "labels"},
        people=("decided_by",),
    ),
    Table(
        "work_items",
        WorkItem,
        "world",
        {
            "utterance": "utterances",
            "template": "templates",
            "paraphrase": "paraphrases",
            "follows": "work_items",
        },
        people=("created_by",),
    ),
    Table(
        "assignments",
        Assignment,
        references={"item": "work_items", "label": "labels"},
        people=("person", "assigned_by"),
    ),
    Table("work_shares", WorkShare, "world"),
    Table("splits", Split, "world", {"follows": "splits"}, people=("created_by",)),
    Table("examples", Example, references={"split": "splits"}),
    Table("problems", StoredProblem, "world"),
    Table(
        "comments",
        Comment,
        "world",
        people=("author", "deleted_by"),
        subjects={
            "template": "templates",
            "production": "productions",
            "entity": "entities",
            "predicate": "predicates",
            "paraphrase": "paraphrases",
            "form": "forms",
            "utterance": "utterances",
        },
    ),
    Table("earlier_texts", EarlierText, references={"comment": "comments"}),
)


@cache
def tables() -> tuple[Table, ...]:
    """Return all tables of an archive: ours, then those that other applications have registered."""
    return (*OUR_TABLES, *map(import_string, registered_parts()))
