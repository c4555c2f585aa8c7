"""Many rows of every kind that people and parsers leave in a world, by one statement for each table."""

from __future__ import annotations

from typing import NamedTuple

from django.db import connection, models

from annotations.exchange.world_deletion import deletion_order, paths_to_world
from annotations.models import (
    Assignment,
    AuditEntry,
    AuditFinding,
    AuditReason,
    CampaignPrompt,
    Command,
    CommandProposal,
    Comment,
    Contributor,
    EarlierText,
    Example,
    FindingStatus,
    Grammar,
    Guidelines,
    Job,
    Label,
    LogicalForm,
    Notice,
    Ontology,
    Paraphrase,
    Proposal,
    SemanticTemplate,
    Submission,
    Upload,
    Utterance,
    WorkItem,
    World,
)
from annotations.models.background import Status
from annotations.models.queueing import Outcome
from parser_service.models import (
    ActionNames,
    Answering,
    Dialogue,
    Evaluation,
    OfferedEntity,
    Prediction,
    Probe,
    ProbeAnswer,
    Review,
    RunEvent,
)

# What a world has more of the longer people work in it. The others describe it, or are few: splits, runs, people.
GROWING: tuple[type[models.Model], ...] = (
    *(Assignment, AuditEntry, AuditFinding, AuditReason, CampaignPrompt, Command),
    *(CommandProposal, Comment, Contributor, Dialogue, EarlierText, Example, Job, Label),
    *(LogicalForm, Notice, OfferedEntity, Paraphrase, Prediction, Probe, ProbeAnswer),
    *(Proposal, Review, RunEvent, Submission, Upload, Utterance, WorkItem),
    *(each.history.model for each in (Paraphrase, SemanticTemplate, Utterance)),
)
TIMES = {Prediction: 10}  # as many as of another kind
FEW = 4  # copies of each row that does not grow
# A world has one of these, or an evaluation for each of the parts and sources that there are.
SAME = (ActionNames, Answering, Evaluation, Grammar, Guidelines, Ontology)
# Texts that are another one in each copy, whether or not they have to be.
OWN_TEXTS = {"text", "utterance", "title", "anonymized_text"}
SPECIAL = {
    # Still a form with the same head, as pages read it.
    (LogicalForm, "text"): "substr(text, 1, length(text) - 1) || '\" n' || k || ' \" )'",
    # Nobody holds a million items at once, no million jobs wait, and audits open few findings at once.
    (Assignment, "outcome"): f"'{Outcome.DONE}'",
    (Assignment, "done_at"): "CURRENT_TIMESTAMP",
    (AuditFinding, "status"): f"'{FindingStatus.KEPT}'",
    (Job, "status"): f"'{Status.SUCCEEDED}'",
    (Job, "finished_at"): "queued_at",
    (Comment, "subject"): "subject + k * 1000",  # nobody writes a million comments on one row
}


class Originals(NamedTuple):
    """Keys of the rows of a model. Copy ``k`` of the row ``key`` has the key ``k * stride + key``; ``copies`` of
    each there are."""

    keys: list[int]
    stride: int
    copies: int


class ManyRows:
    """Copies of the rows below ``world``, which has one of every kind."""

    def __init__(self, world: World) -> None:
        paths = {**paths_to_world(), AuditEntry: "world"}
        self.originals: dict[type[models.Model], Originals] = {}
        for model in [*reversed(deletion_order(paths_to_world())), AuditEntry]:
            rows = model._base_manager.order_by("pk")
            keys = list(rows.filter(**{paths[model]: world.pk}).values_list("pk", flat=True))
            if keys and model not in SAME:
                self.originals[model] = Originals(keys, rows.last().pk + 1, 0)

    def multiply(self, rows: int) -> int:
        """Go on until there are about ``rows`` of every kind that grows. Return how many were written.

        Rows that refer to each other have copies that do. What has to be unique gets a number; a row that must
        not be there twice all the same is left out.
        """
        return sum(self._copy(model, rows) for model in self.originals)

    def _copy(self, model: type[models.Model], rows: int) -> int:
        keys, stride, copied = self.originals[model]
        wanted = rows * TIMES.get(model, 1) // len(keys) if model in GROWING else FEW
        self.originals[model] = Originals(keys, stride, max(copied, wanted))
        values = [self._value_of(field) for field in model._meta.concrete_fields]
        columns = ", ".join(f'"{field.column}"' for field in model._meta.concrete_fields)
        with connection.cursor() as cursor:
            cursor.execute(
                f'INSERT INTO "{model._meta.db_table}" ({columns}) '
                f"WITH RECURSIVE numbers(k) AS (SELECT CAST({copied + 1} AS bigint) "
                f"WHERE {copied} < {wanted} UNION ALL SELECT k + 1 FROM numbers WHERE k < {wanted}) "
                f'SELECT {", ".join(values)} FROM "{model._meta.db_table}" CROSS JOIN numbers '
                f'WHERE "{model._meta.pk.column}" IN ({", ".join(map(str, keys))}) '
                "ON CONFLICT DO NOTHING"
            )
            return cursor.rowcount

    def _value_of(self, field: models.Field) -> str:
        """Return the SQL of a column in copy ``k``."""
        model, column = field.model, f'"{field.column}"'
        if field.primary_key:
            return f"{column} + k * {self.originals[model].stride}"
        if field.is_relation:
            of = self.originals.get(field.related_model)
            return f"{column} + ((k - 1) % {of.copies} + 1) * {of.stride}" if of else column
        if (model, field.name) in SPECIAL:
            return SPECIAL[model, field.name]
        is_own = model in GROWING and field.name in OWN_TEXTS
        if field.choices or not (is_own or _is_unique(field)):
            return column
        if isinstance(field, models.PositiveSmallIntegerField):  # the rank among those of one row
            parents = [self.originals[each] for each in _referred(model) & self.originals.keys()]
            return f"{column} + (k - 1) / {min((each.copies for each in parents), default=10**9)}"
        if isinstance(field, models.IntegerField):
            return f"{column} + k * 1000"
        if isinstance(field, (models.CharField, models.TextField)):
            between = " " if is_own else "_"  # which names may have
            return f"substr({column}, 1, {(field.max_length or 10**6) - 9}) || '{between}' || k"
        return column


def _is_unique(field: models.Field) -> bool:
    """Whether the column is unique, by itself or with others."""
    meta = field.model._meta
    names = {name for some in meta.constraints for name in getattr(some, "fields", ())}
    return field.unique or field.name in names


def _referred(model: type[models.Model]) -> set[type[models.Model]]:
    """Return the kinds that grow to which rows of the model refer."""
    return {field.related_model for field in model._meta.concrete_fields} & set(GROWING)
