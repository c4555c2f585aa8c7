"""How much there is of everything in a world, and how much of it waits for somebody.

Most numbers are counted for each page. Those of what a world may have very many of are counted for each page
too while there are few. After that a process keeps them for a while that is long beside the time of counting,
so that a page costs the same however many rows there are (docs/design/decisions.md).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from time import monotonic
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
    Job,
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
from annotations.rows.kept import MOST_READ, Kept
from parser_service.models import Promotion, TrainingRun

# What a world may have very many of.
LARGE = (
    *("commands", "command_problems", "forms", "paraphrases", "paraphrases_waiting"),
    *("utterances", "utterances_waiting", "work_items", "work_items_free", "audit_findings"),
)
MOST_EXACT = 1_000  # free work items; nobody may be told that there is work where there is none


@dataclass(frozen=True, slots=True)
class Counts:
    """Numbers of rows of one world.

    ``uncovered`` counts the commands of the grammar without a logical form, as of the last import or
    generation; ``stale`` is 1 where grammar or templates have changed since the last generation.
    ``utterances_waiting`` have no form and are no free item of the queue, so that nothing is counted twice.
    ``runs_failed`` and ``runs_lost`` leave out a run if the same parser has succeeded on the same split
    since. ``age`` is the seconds since those of ``LARGE`` were counted.
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
    age: float = 0

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


Stamp = tuple[int, int]  # how often commands were generated, and the newest job that has ended


# ``LARGE`` of the worlds with more than MOST_READ rows, by key.
_kept: dict[int, Kept[dict[str, int]]] = {}
_in_hand: set[int] = set()  # the keys of those that a thread counts anew; others take what is kept


def counts_of(world: World) -> Counts:
    """Count the rows of ``world``."""
    return counts_of_all(World.objects.filter(pk=world.pk))[world.pk]


def counts_of_all(worlds: QuerySet[World]) -> dict[int, Counts]:
    """Count the rows of several worlds, by key. Two queries, one where the large numbers are kept."""
    try:
        keys, chosen = worlds.order_by().values("id").query.sql_with_params()
    except EmptyResultSet:
        return {}
    small = _count(_small_statement(MOST_EXACT), keys, chosen)
    stamps = {key: (each.pop("generations"), each.pop("job")) for key, each in small.items()}
    large = _large_numbers(stamps)
    counted = {}
    for key, numbers in small.items():
        some_free, kept = numbers.pop("some_free"), large[key]
        free = kept.value["work_items_free"]
        exact = some_free if some_free < MOST_EXACT else max(some_free, free)
        counted[key] = Counts(**{**numbers, **kept.value, "work_items_free": exact}, age=kept.age)
    return counted


def _large_numbers(stamps: dict[int, Stamp]) -> dict[int, Kept[dict[str, int]]]:
    """Return the numbers of ``LARGE`` of the worlds with these keys, counted now or kept."""
    began = monotonic()
    large = {
        key: kept
        for key, stamp in stamps.items()
        if (kept := _kept.get(key)) and (key in _in_hand or not kept.is_due(stamp))
    }
    if not (missing := [key for key in stamps if key not in large]):
        return large
    _in_hand.update(missing)
    try:
        counted = _count(_large_statement(), ", ".join(["%s"] * len(missing)), missing)
    finally:
        _in_hand.difference_update(missing)
    seconds = monotonic() - began
    total = sum(sum(numbers.values()) for numbers in counted.values())
    for key in missing:
        numbers = counted.get(key) or dict.fromkeys(LARGE, 0)  # deleted this moment
        rows = sum(numbers.values())
        large[key] = Kept(numbers, began, seconds * rows / max(total, 1), stamps[key])
        if rows > MOST_READ:
            _kept[key] = large[key]
        else:
            _kept.pop(key, None)
    return large


def _count(
    statement: tuple[str, tuple[Any, ...]], keys: str, chosen: Iterable[Any]
) -> dict[int, dict[str, int]]:
    """Return what a statement counts for the worlds whose keys a list or query of SQL says: key → name → number."""
    counting, values = statement
    with connection.cursor() as cursor:
        query = f"SELECT * FROM ({counting}) AS counted WHERE id IN ({keys})"
        cursor.execute(query, [*values, *chosen])
        names = [each[0].removeprefix("n_") for each in cursor.description[1:]]
        return {key: dict(zip(names, row, strict=True)) for key, *row in cursor.fetchall()}


@cache
def _small_statement(most_free: int) -> tuple[str, tuple[Any, ...]]:
    """Return the query that counts for every world what there is little of: the key, the fields of ``Counts`` but
    ``LARGE``, the stamp, and the free items up to ``most_free``.

    Composed once: Django takes longer for that than the database for the answer.
    """
    rows = _rows_to_count()
    counted: dict[str, Expression | F | Subquery[Any]] = {
        name: _aggregate(*rows[name], Count("pk")) for name in rows if name not in LARGE
    }
    counted["members"] = _aggregate(Membership.objects.all(), "world", Count("user", distinct=True))
    without_form = F("commands_in_grammar") - F("commands_with_form")
    categories = TaskCategory.objects.filter(commands_in_grammar__isnull=False)
    counted["uncovered"] = _aggregate(categories, "grammar__world", Sum(without_form))
    counted["stale"] = Case(When(generated_revision__lt=F("revision"), then=1), default=0)
    counted["generations"] = F("generations")
    ended = Job.objects.filter(world=OuterRef("pk"), finished_at__isnull=False).order_by("-id")
    counted["job"] = Coalesce(Subquery(ended.values("id")[:1]), 0)
    free = WorkItem.objects.free().filter(world=OuterRef("pk")).order_by("-priority", "id")
    some_free = free.values("pk")[:most_free]
    counted["some_free"] = Subquery(
        some_free,
        output_field=IntegerField(),
        template="(SELECT COUNT(*) FROM (%(subquery)s) AS some_free)",
    )
    return _statement(counted)


@cache
def _large_statement() -> tuple[str, tuple[Any, ...]]:
    """Return the query that counts for every world what there may be very much of: the key, then ``LARGE``."""
    rows = _rows_to_count()
    return _statement({name: _aggregate(*rows[name], Count("pk")) for name in LARGE})


def _statement(
    counted: Mapping[str, Expression | F | Subquery[Any]],
) -> tuple[str, tuple[Any, ...]]:
    columns = {f"n_{name}": expression for name, expression in counted.items()}
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
