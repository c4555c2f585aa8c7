"""Which rows make up a world, and how a row becomes a line of JSON and a row again."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property
from typing import Any

from django.db import models
from django.utils.module_loading import import_string

from annotations.apps import workbench_apps
from annotations.models import (
    Assignment,
    AuditDecision,
    AuditFinding,
    AuditReason,
    Campaign,
    CampaignPrompt,
    Command,
    Comment,
    Contributor,
    EarlierText,
    Entity,
    EntityClass,
    Example,
    Guidelines,
    Label,
    LogicalForm,
    Paraphrase,
    Predicate,
    Primitive,
    Production,
    Recipe,
    SemanticTemplate,
    Split,
    StoredProblem,
    Submission,
    TaskCategory,
    Utterance,
    WorkItem,
    WorkShare,
    World,
)
from annotations.models.campaigns import ContributorKind
from annotations.rows.row_kinds import KINDS

FORMAT, VERSION = "gpsr-workbench-world", 1
NONE_OF_THEM: Mapping[str, Any] = {"pk__in": ()}
WORLD_FIELDS = ("description", "revision", "generated_revision", "sample")


@dataclass(frozen=True)
class ArchiveTable:
    """The rows of one model in one world, as the file ``rows/NAME.jsonl``.

    Attributes:
        owner: the field that leads to the world, through the grammar or ontology where it is one of these;
            it is not written. Empty where the first reference leads there.
        references: field → table of the rows that it refers to, by line number from 0; those of its own
            table are earlier.
        people: the fields that refer to accounts, by user name.
        subjects: kind of a row → table of the row that its field ``subject`` refers to, if to any.
        shapes: JSON column of another application's table → whether a value may stand there.
        utterance: the lookup that leads to an utterance. Deleted ones, and what hangs on them, are not written.
        left_out: columns that are not written either.
        keeps_texts: whether an import leaves the texts as they are, without normalising them.
        unreviewed: lookups for those of the rows that readers get who may not review; None: all of them.
    """

    name: str
    model: type[models.Model]
    owner: str = ""
    references: Mapping[str, str] = field(default_factory=dict)
    people: tuple[str, ...] = ()
    subjects: Mapping[str, str] = field(default_factory=dict)
    shapes: Mapping[str, Callable[[Any], bool]] = field(default_factory=dict)
    utterance: str = ""
    left_out: tuple[str, ...] = ()
    keeps_texts: bool = False
    unreviewed: Mapping[str, Any] | None = None

    @property
    def path(self) -> str:
        return f"rows/{self.name}.jsonl"

    @cached_property
    def columns(self) -> tuple[models.Field[Any, Any], ...]:
        """The fields that are written as they are; derived ones follow from them."""
        apart = {"id", self.owner, *self.references, *self.people, *self.left_out}
        apart |= {"subject"} if self.subjects else set()
        return tuple(
            column
            for column in self.model._meta.concrete_fields
            if column.name not in apart
            and not getattr(column, "auto_now_add", False)
            and not getattr(column, "is_derived", False)
        )

    def rows_of(self, world: World, may_review: bool = True) -> models.QuerySet[Any]:
        """Return the rows that the archive of ``world`` has for somebody who may review, or may not."""
        chosen: dict[str, Any] = {self.world_path: world}
        if self.utterance:
            chosen[f"{self.utterance}__deleted_at__isnull"] = True
        rows = self.model._default_manager.filter(**chosen)
        if may_review or self.unreviewed is None:
            return rows
        return rows.filter(**self.unreviewed).distinct()

    @cached_property
    def world_path(self) -> str:
        """The lookup that leads from a row to its world."""
        if not self.owner:
            name, table = next(iter(self.references.items()))
            above = next(each for each in tables() if each.name == table)
            return f"{name}__{above.world_path}"
        is_direct = self.model._meta.get_field(self.owner).related_model is World
        return self.owner if is_direct else f"{self.owner}__world"


# Rows stand behind those that they refer to.
TABLES_OF_ROWS = (
    ArchiveTable("entity_classes", EntityClass, "world"),
    ArchiveTable("entities", Entity, "ontology"),
    ArchiveTable("task_categories", TaskCategory, "grammar"),
    ArchiveTable("productions", Production, "grammar"),
    ArchiveTable("predicates", Predicate, "world"),
    ArchiveTable("templates", SemanticTemplate, "grammar", people=("author",)),
    ArchiveTable("primitives", Primitive, "world"),
    ArchiveTable("recipes", Recipe, "world"),
    ArchiveTable("guidelines", Guidelines, "world"),
    ArchiveTable("forms", LogicalForm, "world"),
    ArchiveTable("commands", Command, "world", {"template": "templates", "logical_form": "forms"}),
    # The link of a campaign is of one site, where the copy gets another one; its codes are secrets.
    ArchiveTable(
        "campaigns",
        Campaign,
        "world",
        people=("created_by",),
        left_out=("key", "completion_code", "screened_out_code"),
        unreviewed={"contributors__kind": ContributorKind.MODEL},
    ),
    ArchiveTable(
        "campaign_prompts",
        CampaignPrompt,
        references={"campaign": "campaigns", "command": "commands"},
        unreviewed=NONE_OF_THEM,
    ),
    # That a model wrote a paraphrase is on its page; which person wrote it is for those who review.
    ArchiveTable(
        "contributors",
        Contributor,
        references={"campaign": "campaigns"},
        left_out=("saves", "saves_since"),
        unreviewed={"kind": ContributorKind.MODEL},
    ),
    ArchiveTable(
        "paraphrases",
        Paraphrase,
        "world",
        {"command": "commands", "contributor": "contributors"},
    ),
    ArchiveTable(
        "utterances",
        Utterance,
        "world",
        people=("created_by",),
        left_out=("upload", "deleted_at"),
    ),
    ArchiveTable(
        "submissions",
        Submission,
        references={
            "contributor": "contributors",
            "prompt": "campaign_prompts",
            "paraphrase": "paraphrases",
            "utterance": "utterances",
        },
        people=("decided_by",),
        left_out=("read_by_run", "browser"),
        utterance="utterance",
        unreviewed=NONE_OF_THEM,
    ),
    ArchiveTable(
        "labels",
        Label,
        references={"utterance": "utterances"},
        people=("annotator",),
        utterance="utterance",
    ),
    ArchiveTable(
        "audit_findings",
        AuditFinding,
        "world",
        {"paraphrase": "paraphrases", "utterance": "utterances"},
        utterance="utterance",
    ),
    ArchiveTable(
        "audit_reasons",
        AuditReason,
        references={"finding": "audit_findings"},
        utterance="finding__utterance",
    ),
    ArchiveTable(
        "audit_decisions",
        AuditDecision,
        references={"finding": "audit_findings", "label": "labels"},
        people=("decided_by",),
        utterance="finding__utterance",
    ),
    ArchiveTable(
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
        utterance="utterance",
    ),
    ArchiveTable(
        "assignments",
        Assignment,
        references={"item": "work_items", "label": "labels"},
        people=("person", "assigned_by"),
        utterance="item__utterance",
    ),
    ArchiveTable("work_shares", WorkShare, "world"),
    # The figures of a split are counted again, with the check of its hash.
    ArchiveTable(
        "splits",
        Split,
        "world",
        {"follows": "splits"},
        people=("created_by",),
        left_out=("figures",),
    ),
    ArchiveTable("examples", Example, references={"split": "splits"}, keeps_texts=True),
    ArchiveTable("problems", StoredProblem, "world"),
)
OUR_TABLES = (
    *TABLES_OF_ROWS,
    ArchiveTable(
        "comments",
        Comment,
        "world",
        people=("author", "deleted_by"),
        subjects={
            "form": "forms",
            **{
                kind.name: table.name
                for kind in KINDS.values()
                for table in TABLES_OF_ROWS
                if table.model is kind.model
            },
        },
    ),
    ArchiveTable("earlier_texts", EarlierText, references={"comment": "comments"}),
)


@cache
def tables() -> tuple[ArchiveTable, ...]:
    """Return all tables of an archive: ours, then those of other apps."""
    theirs = (import_string(dotted) for app in workbench_apps() for dotted in app.archive_tables)
    return (*OUR_TABLES, *theirs)
