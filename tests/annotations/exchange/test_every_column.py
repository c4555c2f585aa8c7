"""Each column of each row of a world arrives with its archive, and comes back from its history.

Models and columns are asked of the site itself: a new one fails here until it arrives, or has a reason in
``LEFT_OUT``.
"""

from __future__ import annotations

from datetime import UTC, datetime
from decimal import Decimal
from typing import Any

import pytest
from django.db import models

from annotations.editing.edits import change, delete, restore
from annotations.exchange.archive_tables import WORLD_FIELDS, ArchiveTable, tables
from annotations.exchange.row_checks import FORMS
from annotations.exchange.world_import import import_world
from annotations.generation.freezing import content_hash_of
from annotations.generation.split_statistics import figures_of
from annotations.models import Comment, Grammar, Ontology, Primitive, Recipe, Split, World
from annotations.rows.history import DELETED, history_of
from annotations.rows.row_kinds import KINDS
from tests.annotations.exchange.packing import pack

# What belongs to a world and does not arrive with its archive, and why.
RUNS = "runs and what was measured by them belong to the installation: a backup has them"
PASSING = "made anew where it is needed, or of one person alone"
LEFT_OUT = {
    "annotations.World.id": "a key of this database",
    "annotations.World.name": "who imports it chooses the name",
    "annotations.World.created_at": "when the copy was made",
    "annotations.World.generations": "how often commands were generated here",
    "annotations.World.deletion_requested_at": "hides a world while it is imported or deleted",
    "annotations.Campaign.key": "the link of one site; the copy gets its own",
    "annotations.Campaign.completion_code": "a secret",
    "annotations.Campaign.screened_out_code": "a secret",
    "annotations.Contributor.saves": "a limit of the last minute",
    "annotations.Contributor.saves_since": "a limit of the last minute",
    "annotations.Split.figures": "counted again from the examples",
    "annotations.Submission.browser": "the copy has no page that asks for it",
    "annotations.Submission.read_by_run": RUNS,
    "annotations.Utterance.upload": "an upload can be undone only where it was made",
    "annotations.Utterance.deleted_at": "deleted utterances stay behind",
    "annotations.Split.created_at": "when the copy was made",
    "annotations.Membership": "who imports a world is its admin; accounts stay behind",
    "annotations.Invitation": "a secret of one site",
    "annotations.Job": PASSING,
    "annotations.Upload": PASSING,
    "annotations.Draft": PASSING,
    "annotations.Notice": PASSING,
    "annotations.Proposal": PASSING,
    "annotations.CommandProposal": PASSING,
    "parser_service.Dialogue": PASSING,
    "parser_service.OfferedEntity": PASSING,
    "parser_service.Tryout": PASSING,
    "parser_service.ExampleColumns": PASSING,
    **dict.fromkeys(
        (
            f"parser_service.{name}"
            for name in (
                *("TrainingRun", "EpochMetric", "Checkpoint", "RunEvent", "RunAnalysis", "Probe"),
                *("ProbeAnswer", "AnswererEvaluation", "AnswerColumns", "Evaluation"),
                *("Prediction", "Promotion", "Slice", "ErrorCategory", "Review"),
            )
        ),
        RUNS,
    ),
}
# Columns of which not every value means something, by table and name or by name alone; the second one is that of
# the second row.
FORM = ("( go )", "( wave )")
MEANT: dict[str, tuple[Any, Any]] = {
    **{f"{table}.{name}": FORM for table, names in FORMS.items() for name in names},
    "entity_classes.token": ("pose", "tool"),
    "entity_class": ("pose", "tool"),
    "task_category": ("cat1", "cat2"),
    "task_categories.name": ("cat1", "cat2"),
    **{f"{table}.source": ("é.txt", "b.txt") for table in ("productions", "templates", "entities")},
    "productions.nonterminal": ("Main", "Main"),
    "productions.expansion": ("go", "tea"),
    "predicates.name": ("go", "wave"),
    "rule_sources": (["é.txt"], ["b.txt"]),
    "template_sources": (["é.txt"], ["b.txt"]),
    "templates.form": FORM,
    "comments.kind": ("template", "template"),
    "aliases": (["thé"], []),
    "attributes": ({"colour": "grün"}, {}),
    "signatures": ([["pose"]], [[]]),
    "problems": ([], []),
    "spans": ([[0, 2, "object", "tea"]], []),
    "entities": ([{"text": "tea", "aliases": ["thé"], "is_described": True}], []),
    "flags": ([{"code": "copy", "evidence": "ä"}], []),
    "settings": ({"name": "some model", "seed": 1}, {}),
    "proportions": ([0.8, 0.1, 0.1], []),
    "sample": ({}, {}),
    "names": ({"go": {"name": "NavigateTo", "arguments": {}}}, {}),
    "return_url": ("https://example.org/é", ""),
    "screened_out_url": ("https://example.org/ü", ""),
    "currency": ("EUR", ""),
}
BOOKS: dict[type, tuple[str, str]] = {
    Primitive: ('dance() "dance"', 'sing() "sing"'),
    Recipe: ('go(destination) -> say("no")', 'wave() -> say("hello")'),
}


@pytest.fixture
def full(admin) -> World:
    """A world with two rows of everything; each column of the first is filled, and the second has what it must."""
    world = World.objects.create(name="full", description="ä", revision=3, generated_revision=2)
    Grammar.objects.create(world=world)
    Ontology.objects.create(world=world)
    for kind in (world.entity_classes, world.primitives, world.recipes):
        kind.all().delete()
    for table in tables():
        for number in (0, 1) if not is_one_a_world(table) else (0,):
            row = table.model(**values_of(table, world, number, admin))
            table.model._default_manager.bulk_create([row])
    for split in Split.objects.all():
        Split.objects.filter(pk=split.pk).update(content_hash=content_hash_of(split))
    return world


def is_one_a_world(table: ArchiveTable) -> bool:
    unique = [set(each.fields) for each in table.model._meta.total_unique_constraints]
    unique += [{each.name} for each in table.model._meta.concrete_fields if each.unique]
    return {table.owner} in unique


def values_of(table: ArchiveTable, world: World, number: int, admin) -> dict[str, Any]:
    values: dict[str, Any] = {each.attname: value_of(table, each, number) for each in table.columns}
    if table.owner:
        values[table.owner] = world if table.owner == "world" else getattr(world, table.owner)
    for name, other in table.references.items():
        rows = next(each for each in tables() if each.name == other).rows_of(world)
        is_left_out = number == 1 and table.model._meta.get_field(name).null
        values[name] = (
            None
            if is_left_out
            else rows.order_by("pk")[min(number, len(rows) - 1)]
            if rows
            else None
        )
    for name in table.people:
        values[name] = admin if number == 0 else None
    if table.subjects:
        values["subject"] = world.grammar.templates.order_by("pk")[number].pk
    if table.model in BOOKS:
        values |= table.model.columns_of(BOOKS[table.model][number])
    return values


def value_of(table: ArchiveTable, column: models.Field, number: int) -> Any:
    """Return a value that means something to the checks of an import, another one for each row."""
    for name in (f"{table.name}.{column.name}", column.name):
        if name in MEANT:
            return MEANT[name][number]
    if number and column.null:
        return None
    if column.choices:
        return [value for value, _ in column.flatchoices][-1 - number]
    match column:
        case models.SlugField():
            return f"{column.name}-{number}"
        case models.CharField() | models.TextField():
            return f"{column.name} ä {number}"[: column.max_length]
        case models.BooleanField():
            return number == 0
        case models.IntegerField():
            return 5 - number
        case models.FloatField():
            return 0.25 * (1 + number)
        case models.DecimalField():
            return Decimal("1.50")
        case models.DateTimeField():
            return datetime(2024, 2, 29, 23, 59, 59, 123_456, UTC)
    raise NotImplementedError(
        f"{table.name}.{column.name} is of a type for which there is no value"
    )


def test_every_column_arrives(full):
    import_world("again", pack(full))
    again = World.objects.get(name="again")
    assert [getattr(again, name) for name in WORLD_FIELDS] == [
        getattr(full, name) for name in WORLD_FIELDS
    ]
    for table in tables():
        names = [each.attname for each in table.columns]
        rows = [list(table.rows_of(each).order_by("pk").values(*names)) for each in (full, again)]
        assert rows[0] == rows[1], table.name
        for name in (*table.references, *table.people):
            kept = [
                [getattr(row, f"{name}_id") is None for row in table.rows_of(each).order_by("pk")]
                for each in (full, again)
            ]
            assert kept[0] == kept[1], f"{table.name}.{name}"
    assert [each.figures for each in again.splits.all()] == [
        figures_of(each).as_json() for each in full.splits.all()
    ]
    assert (
        again.comments.get(pk=again.comments.first().pk).subject
        == again.grammar.templates.order_by("pk").first().pk
    )


def test_every_column_below_a_world_arrives_or_has_a_reason():
    arriving = {table.model: table for table in tables()}
    names = {f"annotations.World.{name}" for name in left_out(World, set(WORLD_FIELDS))}
    for model in below_a_world() - {Grammar, Ontology}:
        if (table := arriving.get(model)) is None:
            names.add(model._meta.label)
            continue
        written = {each.name for each in table.columns} | {*table.references, *table.people}
        written |= {"id", table.owner, *(["subject"] if table.subjects else [])}
        names |= {f"{model._meta.label}.{name}" for name in left_out(model, written)}
    assert names == LEFT_OUT.keys()


def left_out(model: type[models.Model], written: set[str]) -> set[str]:
    """The columns that are not ``written`` and do not follow from those that are."""
    fields = model._meta.concrete_fields
    return {each.name for each in fields if not getattr(each, "is_derived", False)} - written


def below_a_world() -> set[type[models.Model]]:
    pending: list[type[models.Model]] = [World]
    below: set[type[models.Model]] = set()
    while pending:
        for relation in pending.pop()._meta.related_objects:
            if relation.on_delete is models.CASCADE and relation.related_model not in below:
                below.add(relation.related_model)
                pending.append(relation.related_model)
    return below


@pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)
def test_every_column_comes_back_from_the_history(kind, full, admin):
    first, *others = kind.rows_of(full).order_by("pk")
    names = [field.attname for field in kind.model._meta.concrete_fields if field.name != "version"]
    before = {name: getattr(first, name) for name in names}
    edited = (*kind.model.edited_fields, *kind.model.fields_beside)
    other = {name: getattr(others[0], name) for name in edited} if others else {"text": "ö"}
    if kind.name == "entity_class":
        del other["token"]  # it does not change
    for row in others:
        row.delete()
    changed = change(first, other, admin, first.version)
    assert {name: getattr(changed, name) for name in other} == other
    restore(history_of(kind.model).filter(id=first.pk).last(), admin)
    stored = kind.model._default_manager.get(pk=first.pk)
    assert {name: getattr(stored, name) for name in edited} == {
        name: before[name] for name in edited
    }
    if kind.is_deletable:
        as_it_was = kind.model._default_manager.filter(pk=first.pk).values(*names).get()
        delete(stored, admin, stored.version)
        restore(history_of(kind.model).filter(id=first.pk, history_type=DELETED).get(), admin)
        assert kind.model._default_manager.filter(pk=first.pk).values(*names).get() == as_it_was
    assert Comment.objects.count() == 2
