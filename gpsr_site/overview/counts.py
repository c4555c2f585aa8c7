"""How much there is of everything in a world, and how much of it waits for somebody, in one query."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cache
from typing import Any

from django.core.exceptions import EmptyResultSet
from django.db import connection
from django.db.models import (
    Case,
    Count,
    Exists,
    Expression,
    F,
    IntegerField,
    OuterRef,
    QuerySet,
    Subquery,
    Sum,
    When,
)
from django.db.models.functions import Coalesce

from annotations.models import (
    AuditFinding,
    Command,
    Entity,
    LogicalForm,
    Membership,
    Paraphrase,
    Production,
    SemanticTemplate,
    Split,
    StoredProblem,
    TaskCategory,
    Utterance,
    WorkItem,
    World,
)
from annotations.models.background import Status as RunStatus
from annotations.models.corpus import ParaphraseStatus
from annotations.models.description import ProblemSubject, TemplateStatus
from parser_service.models import Promotion, TrainingRun


@dataclass(frozen=True, slots=True)
class Counts:
    """Numbers of rows of one world.

    ``uncovered`` counts the commands of the grammar without a logical form, as of the last import or
    generation; ``stale`` is 1 where grammar or templates have changed since the last generation.
    ``utterances_waiting`` have no form and are no free item of the queue, so that nothing is counted twice.
    ``runs_failed`` and ``runs_lost`` leave out a run if the same parser has succeeded on the same split
    since.
    """

    members: int
    entities: int
    ontology_problems: int
    productions: int
    grammar_problems: int
    templates: int
    template_problems: int
    drafts: int
    disputed: int
    commands: int
    command_problems: int
    uncovered: int
    stale: int
    forms: int
    paraphrases: int
    paraphrases_waiting: int
    utterances: int
    utterances_waiting: int
    work_items: int
    work_items_free: int
    audit_findings: int
    splits: int
    runs: int
    runs_queued: int
    runs_running: int
    runs_failed: int
    runs_lost: int
    evaluated: int
    promotions_proposed: int

    @property
    def awaits_first_commands(self) -> bool:
        """Whether the templates have made no commands yet, so that nobody knows what they leave out."""
        return bool(self.stale and self.templates and not self.commands)

    @property
    def generation_waiting(self) -> int:
        """1 where a generation would make commands, or make those anew that are here."""
        return int(bool(self.stale and (self.commands or self.templates)))

    @property
    def templates_waiting(self) -> int:
        """Templates that make no commands yet."""
        return self.drafts + self.disputed

    @property
    def runs_active(self) -> int:
        """Runs that wait or run."""
        return self.runs_queued + self.runs_running


def counts_of(world: World) -> Counts:
    """Count the rows of ``world``."""
    return counts_of_all(World.objects.filter(pk=world.pk))[world.pk]


def counts_of_all(worlds: QuerySet[World]) -> dict[int, Counts]:
    """Count the rows of several worlds, by key."""
    counting, values = _statement()
    try:
        keys, chosen = worlds.order_by().values("id").query.sql_with_params()
    except EmptyResultSet:
        return {}
    with connection.cursor() as cursor:
        query = f"SELECT * FROM ({counting}) AS counted WHERE id IN ({keys})"
        cursor.execute(query, [*values, *chosen])
        return {key: Counts(*numbers) for key, *numbers in cursor.fetchall()}


@cache
def _statement() -> tuple[str, tuple[Any, ...]]:
    """Return the query that counts for every world: the key, then the fields of ``Counts``.

    Composed once: Django takes longer for that than the database for the answer.
    """
    counted: dict[str, Expression] = {
        name: _aggregate(rows, path, Count("pk")) for name, (rows, path) in _rows_to_count().items()
    }
    counted["members"] = _aggregate(Membership.objects.all(), "world", Count("user", distinct=True))
    without_form = F("commands_in_grammar") - F("commands_with_form")
    categories = TaskCategory.objects.filter(commands_in_grammar__isnull=False)
    counted["uncovered"] = _aggregate(categories, "grammar__world", Sum(without_form))
    counted["stale"] = Case(When(generated_revision__lt=F("revision"), then=1), default=0)
    columns = {f"n_{field.name}": counted[field.name] for field in fields(Counts)}
    rows = World.objects.order_by().annotate(**columns).values("id", *columns)
    statement: tuple[str, tuple[Any, ...]] = rows.query.sql_with_params()
    return statement


def _rows_to_count() -> dict[str, tuple[QuerySet[Any], str]]:
    """Return for each count the rows that it counts and their path to the world."""
    templates, problems, runs = SemanticTemplate.objects, StoredProblem.objects, TrainingRun.objects
    return {
        "entities": (Entity.objects.all(), "ontology__world"),
        "productions": (Production.objects.all(), "grammar__world"),
        "templates": (templates.all(), "grammar__world"),
        "template_problems": (templates.with_problems(), "grammar__world"),
        "drafts": (templates.filter(status=TemplateStatus.DRAFT), "grammar__world"),
        "disputed": (templates.filter(status=TemplateStatus.DISPUTED), "grammar__world"),
        "commands": (Command.objects.all(), "world"),
        "forms": (LogicalForm.objects.all(), "world"),
        "paraphrases": (Paraphrase.objects.all(), "world"),
        "paraphrases_waiting": (
            Paraphrase.objects.filter(status=ParaphraseStatus.PENDING),
            "world",
        ),
        "utterances": (Utterance.objects.all(), "world"),
        "utterances_waiting": (_not_asked_about(), "world"),
        "work_items": (WorkItem.objects.open(), "world"),
        "work_items_free": (WorkItem.objects.free(), "world"),
        "audit_findings": (AuditFinding.objects.open(), "world"),
        "splits": (Split.objects.all(), "world"),
        "ontology_problems": (problems.filter(subject=ProblemSubject.ONTOLOGY), "world"),
        "grammar_problems": (problems.filter(subject=ProblemSubject.GRAMMAR), "world"),
        "command_problems": (problems.filter(subject=ProblemSubject.COMMANDS), "world"),
        "runs": (runs.all(), "world"),
        "runs_queued": (runs.queued(), "world"),
        "runs_running": (runs.running(), "world"),
        "runs_failed": (runs.filter(status=RunStatus.FAILED).not_succeeded_since(), "world"),
        "runs_lost": (runs.filter(status=RunStatus.LOST).not_succeeded_since(), "world"),
        "evaluated": (runs.succeeded(), "world"),
        "promotions_proposed": (Promotion.objects.proposed(), "world"),
    }


def _not_asked_about() -> QuerySet[Utterance]:
    """Return the utterances without a form that are no free item of the queue: those are counted there."""
    asked = WorkItem.objects.free().filter(utterance=OuterRef("pk"))
    return Utterance.objects.unlabelled().exclude(Exists(asked))


def _aggregate(rows: QuerySet[Any], path: str, value: Count | Sum) -> Coalesce:
    """Return ``value`` over the rows of each world, 0 where it has none."""
    of_world = rows.order_by().filter(**{path: OuterRef("pk")}).values(path)
    amounts = of_world.annotate(amount=value).values("amount")
    return Coalesce(Subquery(amounts, output_field=IntegerField()), 0)
