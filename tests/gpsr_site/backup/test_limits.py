"""What one database cannot hold is stored in none, so that an installation can always move.

Models and columns are asked of the site itself, so that a new one is tried too.
"""

from __future__ import annotations

import json
import zipfile
from pathlib import Path

import pytest
from django.apps import apps
from django.core.checks import ERROR
from django.core.checks.registry import registry
from django.core.serializers.json import DjangoJSONEncoder
from django.db import DatabaseError, connection, models, transaction

from annotations.models import Predicate, SemanticTemplate, User
from annotations.models.short_texts import ShortTextField
from annotations.models.worlds import Role
from gpsr_site.backup.backup_checks import CODE, check_column, check_columns
from gpsr_site.backup.backup_manifest import NAME
from gpsr_site.backup.backup_reading import restore
from gpsr_site.backup.backup_tables import fault_of, tables
from tests.annotations.commands.run_command import run, run_process
from tests.conftest import member
from tests.filled_world import leave_traces
from tests.gpsr_site.backup.limits import beyond_the_limit, fill_every_column
from tests.gpsr_site.backup.test_round_trip import backup_of, changed, small, var
from tests.migrated import copy_installation

__all__ = ["small", "var"]

COLUMNS = [
    (model, field)
    for model in apps.get_models()
    for field in model._meta.concrete_fields
    if model._meta.managed
]


@pytest.fixture
def traces(small) -> None:
    """Rows of most models."""
    with transaction.atomic():
        leave_traces(small, User.objects.get(username="anna"), member(small, "adam", Role.ADMIN))


@pytest.mark.skipif(connection.vendor != "sqlite", reason="PostgreSQL holds limits by itself")
def test_each_column_of_sqlite_has_the_constraint_of_its_limit(db):
    with connection.cursor() as cursor:
        cursor.execute("SELECT name, sql FROM sqlite_master WHERE type = 'table'")
        written = dict(cursor.fetchall())
    limited = 0
    for model, field in COLUMNS:
        if check := field.db_check(connection):
            assert check in written[model._meta.db_table], f"{model.__name__}.{field.name}"
            limited += isinstance(field, models.CharField)
    assert limited > 100


def test_rows_that_may_be_there_already_break_no_limit_in_silence(traces):
    there = Predicate.objects.first()
    there.pk = None
    Predicate.objects.bulk_create([there], ignore_conflicts=True)
    there.name = "x" * 10_000
    with pytest.raises(DatabaseError), transaction.atomic():
        Predicate.objects.bulk_create([there], ignore_conflicts=True)


def test_nothing_beyond_a_limit_can_be_stored(traces):
    tried = set()
    for model, field in COLUMNS:
        row = model._base_manager.order_by("pk").first()
        if row is None or field.primary_key or field.is_relation:
            continue
        if isinstance(field, ShortTextField):  # it cuts what is too long
            continue
        for value in beyond_the_limit(field):
            place = f"{model.__name__}.{field.name} = {str(value)[:20]}…"
            with transaction.atomic():
                try:
                    with transaction.atomic():
                        model._base_manager.filter(pk=row.pk).update(**{field.name: value})
                except (DatabaseError, ValueError, OverflowError):
                    tried.add(model)
                else:
                    pytest.fail(f"{place} was stored")
                transaction.set_rollback(True)
            assert fault_of(field, value), place
    assert len(tried) > 30


# Fills each column of each model, in an installation on SQLite.
FILL = """
from pathlib import Path
from gpsr_site.backup.backup_writing import write_backup
from tests.gpsr_site.backup.limits import fill_every_column
fill_every_column()
write_backup(Path(PATH))
"""


@pytest.mark.processes
def test_rows_at_every_limit_go_to_the_other_database_and_back(
    transactional_db, var, migrated_database, tmp_path
):
    older = copy_installation(migrated_database, tmp_path / "older")
    one, two, three = (tmp_path / name for name in ("one.zip", "two.zip", "three.zip"))
    done = run_process(older, "shell", "-c", FILL.replace("PATH", repr(str(one))))
    assert done.returncode == 0, done.stderr

    restore(one)
    rows, _ = backup_of(two)
    assert rows == rows_of(one)
    assert {count for count, _ in rows.values()} == {3}
    assert len(User.objects.get(pk=1).username) == 150
    newer = copy_installation(migrated_database, tmp_path / "newer")
    for command in (("restore", two), ("backup", three)):
        done = run_process(newer, *command)
        assert done.returncode == 0, done.stderr
    assert rows_of(three) == rows


def test_every_column_of_every_model_comes_back(transactional_db, var, tmp_path):
    fill_every_column()
    before = contents()
    rows, _ = backup_of(tmp_path / "one.zip")
    restore(tmp_path / "one.zip", replace=True)
    assert contents() == before
    assert backup_of(tmp_path / "two.zip")[0] == rows


def contents() -> dict[str, list[dict]]:
    """Every value of every row; bytes as bytes, whatever the database's driver gives."""
    return {
        table.name: [
            {
                key: bytes(value) if isinstance(value, memoryview) else value
                for key, value in row.items()
            }
            for row in table.model._base_manager.order_by("pk").values()
        ]
        for table in tables()
    }


class Bits(models.Field):
    """A column of a type of our own that does not read what it writes."""


def test_a_column_that_no_backup_can_hold_stops_the_start():
    assert not check_columns()
    for field in (Bits(), models.FileField(), models.JSONField(encoder=DjangoJSONEncoder)):
        field.set_attributes_from_name("odd")
        (error,) = check_column(field)
        assert (error.id, error.level) == (CODE, ERROR) and error.hint
    assert check_columns in registry.registered_checks


def rows_of(path: Path) -> dict[str, tuple[int, str]]:
    with zipfile.ZipFile(path) as archive:
        manifest = json.loads(archive.read(NAME))
    return {name: (part["rows"], part["sha256"]) for name, part in manifest["tables"].items()}


@pytest.mark.skipif(connection.vendor != "sqlite", reason="PostgreSQL holds limits by itself")
def test_a_backup_names_the_row_beyond_a_limit(small, tmp_path):
    row = Predicate.objects.first()
    with connection.cursor() as cursor:
        cursor.execute("PRAGMA ignore_check_constraints = ON")
        try:
            Predicate.objects.filter(pk=row.pk).update(name="p" * 81)
        finally:
            cursor.execute("PRAGMA ignore_check_constraints = OFF")
    _, failure = run("backup", tmp_path / "one.zip")
    assert f"annotations.predicate, row {row.pk}: name has 81 characters" in str(failure)
    assert not (tmp_path / "one.zip").exists()


def with_value(column: str, value: object):
    """Return a change of a backup: one column of the first template."""
    place = [field.name for field in SemanticTemplate._meta.concrete_fields].index(column)

    def change(name: str, data: bytes) -> bytes:
        if name != "rows/annotations.semantictemplate.jsonl":
            return data
        first, *rest = data.splitlines(keepends=True)
        row = json.loads(first)
        row[place] = value
        return json.dumps(row).encode() + b"\n" + b"".join(rest)

    return change


@pytest.mark.parametrize(
    ("column", "value"),
    [
        ("source", "a" * 201),
        ("pattern", "a\0b"),
        ("pattern", "\ud83d"),
        ("position", 2**31),
        ("position", -1),
        ("version", 10**30),
        ("problems", ["\0"]),
        ("problems", [{"a": "\ud83d"}]),
        ("problems", [float("nan")]),
        ("problems", [float("inf")]),
        ("problems", [1e300]),
        ("problems", [10**300]),
        ("problems", json.loads("[" * 600 + "]" * 600)),
        ("version", "many"),
        ("version", []),
    ],
    ids=lambda value: str(value)[:12],
)
def test_a_backup_with_a_row_that_no_database_holds_is_refused_by_name(
    column, value, small, var, tmp_path
):
    before = backup_of(tmp_path / "one.zip")
    odd = changed(tmp_path / "one.zip", tmp_path / "two.zip", with_value(column, value))
    with pytest.raises(ValueError, match=rf"annotations.semantictemplate, row \d+: {column} "):
        restore(odd, replace=True)
    assert backup_of(tmp_path / "three.zip") == before


def test_every_table_has_a_column_that_names_its_rows():
    for table in tables():
        assert any(field.primary_key for field in table.fields), table.name
