"""How much there is of everything in a world, in one query."""

from __future__ import annotations

from dataclasses import dataclass, fields

from django.db.models import Count, IntegerField, OuterRef, QuerySet, Subquery
from django.db.models.functions import Coalesce

from annotations.models import (
    Command,
    Entity,
    LogicalForm,
    Paraphrase,
    Production,
    SemanticTemplate,
    Split,
    StoredProblem,
    World,
)
from annotations.models.corpus import ParaphraseStatus
from annotations.models.problems import Subject
from annotations.models.templates import Status as TemplateStatus
from parser_service.models import TrainingRun


@dataclass(frozen=True, slots=True)
class Counts:
    """Rows of one world. ``…_waiting`` and ``…_problems`` want somebody's attention."""

    entities: int
    ontology_problems: int
    productions: int
    grammar_problems: int
    templates: int
    templates_waiting: int
    commands: int
    forms: int
    paraphrases: int
    paraphrases_waiting: int
    splits: int
    runs: int
    runs_active: int
    evaluated: int


def counts_of(world: World) -> Counts:
    """The counts of ``world``."""
    return counts_of_all(World.objects.filter(pk=world.pk))[world.pk]


def counts_of_all(worlds: QuerySet[World]) -> dict[int, Counts]:
    """The counts of several worlds, by key."""
    names = [field.name for field in fields(Counts)]
    parts = {f"n_{name}": _subquery(rows, path) for name, (rows, path) in _counted().items()}
    found = worlds.order_by().annotate(**parts).values("pk", *parts)
    return {row["pk"]: Counts(**{name: row[f"n_{name}"] for name in names}) for row in found}


def _counted() -> dict[str, tuple[QuerySet, str]]:
    """For each count the rows that it counts and their path to the world."""
    problems = StoredProblem.objects
    templates, runs = SemanticTemplate.objects, TrainingRun.objects
    return {
        "entities": (Entity.objects.all(), "ontology__world"),
        "ontology_problems": (problems.filter(subject=Subject.ONTOLOGY), "world"),
        "productions": (Production.objects.all(), "grammar__world"),
        "grammar_problems": (problems.filter(subject=Subject.GRAMMAR), "world"),
        "templates": (templates.all(), "grammar__world"),
        "templates_waiting": (templates.exclude(status=TemplateStatus.READY), "grammar__world"),
        "commands": (Command.objects.all(), "world"),
        "forms": (LogicalForm.objects.all(), "world"),
        "paraphrases": (Paraphrase.objects.all(), "world"),
        "paraphrases_waiting": (
            Paraphrase.objects.filter(status=ParaphraseStatus.PENDING),
            "world",
        ),
        "splits": (Split.objects.all(), "world"),
        "runs": (runs.all(), "world"),
        "runs_active": (runs.active(), "world"),
        "evaluated": (runs.succeeded(), "world"),
    }


def _subquery(rows: QuerySet, path: str) -> Coalesce:
    counted = (
        rows.order_by()
        .filter(**{path: OuterRef("pk")})
        .values(path)
        .annotate(counted=Count("pk"))
        .values("counted")
    )
    return Coalesce(Subquery(counted, output_field=IntegerField()), 0)
