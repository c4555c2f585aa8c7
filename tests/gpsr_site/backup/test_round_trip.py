"""A backup makes the same installation again, in either database: rows and files equal by hash.

With TEST_DATABASE_URL the ways go from PostgreSQL to SQLite and back, and from an installation on SQLite into
an empty one on PostgreSQL; else between installations on SQLite.
"""

from __future__ import annotations

import json
import zipfile
from hashlib import sha256
from pathlib import Path

import pytest
from django.db import connection, connections, transaction

from annotations.language.texts.errors import Refusal
from annotations.models import ApiToken, LogInSession, SemanticTemplate, User, World
from annotations.models.worlds import Role
from gpsr_site.backup.backup_manifest import NAME
from gpsr_site.backup.backup_reading import restore
from gpsr_site.backup.backup_tables import SNAPSHOT, snapshot, tables
from gpsr_site.backup.backup_writing import write_backup
from parser_service.models import TrainingRun
from parser_service.serving.loading import load_anew
from tests.annotations.commands.run_command import run, run_process
from tests.conftest import client_of, member
from tests.filled_world import leave_traces
from tests.migrated import copy_installation
from tests.sample_world import fill_world


@pytest.fixture
def var(tmp_path, settings) -> Path:
    """A folder of its own for the files of the installation."""
    settings.VAR_DIR = tmp_path / "var"
    settings.RUNS_DIR = settings.VAR_DIR / "runs"
    settings.RUNS_DIR.mkdir(parents=True)
    return settings.VAR_DIR


@pytest.fixture
def small(transactional_db, var) -> World:
    """An installation with one world, one person and a file of a run."""
    world = World.objects.create(name="home")
    sample = fill_world(world)
    member(world, "anna", Role.ANNOTATOR)
    folder = var / "runs" / str(sample.run.pk)
    folder.mkdir()
    (folder / "weights").write_bytes(bytes(range(256)))
    return world


@pytest.fixture
def filled(small, var) -> World:
    """The same after people have worked in it, and a run is being written."""
    world = small
    with transaction.atomic():
        leave_traces(world, User.objects.get(username="anna"), member(world, "adam", Role.ADMIN))
    SemanticTemplate.objects.update(problems=[{"b": 1.5, "a": "ä\u2028\\u0000"}])
    run = TrainingRun.objects.succeeded().first()
    (var / "runs" / str(run.pk) / ".unfinished").mkdir()
    (var / "runs" / str(run.pk) / ".unfinished" / "weights").write_bytes(b"half")
    return world


def backup_of(path: Path):
    manifest = write_backup(path)
    rows = {name: (part.rows, part.sha256) for name, part in manifest.tables.items()}
    return rows, {name: part.sha256 for name, part in manifest.files.items()}


@pytest.mark.processes
def test_an_installation_moves_to_another_database_and_back(
    filled, var, migrated_database, tmp_path
):
    before = backup_of(tmp_path / "one.zip")
    assert sum(rows for rows, _ in before[0].values()) > 100 and before[1]
    elsewhere = copy_installation(migrated_database, tmp_path / "elsewhere")
    for command in (
        ("restore", tmp_path / "one.zip"),
        ("backup", tmp_path / "two.zip"),
    ):
        done = run_process(elsewhere, *command)
        assert done.returncode == 0, done.stderr
    with zipfile.ZipFile(tmp_path / "two.zip") as archive:
        manifest = json.loads(archive.read(NAME))
    assert manifest["database"] == "sqlite"
    rows = {name: (part["rows"], part["sha256"]) for name, part in manifest["tables"].items()}
    assert rows == before[0]
    assert {name: part["sha256"] for name, part in manifest["files"].items()} == before[1]

    client_of(User.objects.get(username="anna"))
    World.objects.create(name="something else")
    restore(tmp_path / "two.zip", replace=True)
    assert backup_of(tmp_path / "three.zip") == before
    assert not LogInSession.objects.exists()


# Fills an installation in a process of its own, as one that was always on SQLite.
FILL = """
from pathlib import Path
from django.db import transaction
from annotations.models import World
from annotations.models.worlds import Role
from gpsr_site.backup.backup_writing import write_backup
from tests.conftest import member
from tests.filled_world import leave_traces
from tests.sample_world import fill_world
world = World.objects.create(name="home")
fill_world(world)
with transaction.atomic():
    leave_traces(world, member(world, "anna", Role.ANNOTATOR), member(world, "adam", Role.ADMIN))
write_backup(Path({path!r}))
"""


@pytest.mark.processes
def test_an_installation_on_sqlite_fills_an_empty_one_of_the_other_database(
    transactional_db, var, migrated_database, tmp_path
):
    older = copy_installation(migrated_database, tmp_path / "older")
    done = run_process(older, "shell", "-c", FILL.format(path=str(tmp_path / "one.zip")))
    assert done.returncode == 0, done.stderr
    written = json.loads(zipfile.ZipFile(tmp_path / "one.zip").read(NAME))
    assert written["database"] == "sqlite"
    rows = {name: (part["rows"], part["sha256"]) for name, part in written["tables"].items()}
    files = {name: part["sha256"] for name, part in written["files"].items()}
    assert sum(count for count, _ in rows.values()) > 100 and files

    restore(tmp_path / "one.zip")  # refused, were anything here
    assert backup_of(tmp_path / "two.zip") == (rows, files)
    for name, digest in files.items():
        assert sha256((var / name).read_bytes()).hexdigest() == digest
    last = TrainingRun.objects.latest("pk")
    assert load_anew(last).predict(["go to the kitchen"], 1)[0]
    assert World.objects.create(name="laboratory").pk > World.objects.get(name="home").pk


def test_what_is_restored_can_be_worked_with(small, var, tmp_path):
    _, key = ApiToken.issue(User.objects.get(username="anna"), "robot")
    last = World.objects.latest("pk").pk
    write_backup(tmp_path / "one.zip")
    restore(tmp_path / "one.zip", replace=True)
    assert ApiToken.objects.for_key(key).user.check_password("correct horse")
    assert World.objects.create(name="laboratory").pk > last


def test_files_that_were_here_are_put_aside(small, var, tmp_path):
    write_backup(tmp_path / "one.zip")
    (var / "runs" / "mine").write_text("kept")
    restore(tmp_path / "one.zip", replace=True)
    (aside,) = var.glob("runs-before-restoring-*")
    assert (aside / "mine").read_text() == "kept"
    assert not (var / "runs" / "mine").exists() and not (var / ".restoring").exists()


def test_a_backup_sees_one_moment(small, tmp_path):
    with snapshot() as using:
        before = World.objects.using(using).count()
        World.objects.create(name="meanwhile")  # nobody waits
        assert World.objects.using(using).count() == before
    assert World.objects.count() == before + 1
    assert SNAPSHOT not in connections


def test_it_is_nobodys_business_but_of_who_wrote_it(small, tmp_path):
    write_backup(tmp_path / "one.zip")
    assert (tmp_path / "one.zip").stat().st_mode & 0o077 == 0
    with zipfile.ZipFile(tmp_path / "one.zip") as archive:
        assert not any("session" in name for name in archive.namelist())


def test_an_installation_with_something_in_it_is_not_overwritten(small, tmp_path):
    write_backup(tmp_path / "one.zip")
    _, failure = run("restore", tmp_path / "one.zip")
    assert failure.__cause__.code == "not_empty" and failure.returncode == 1
    _, failure = run("backup", tmp_path / "one.zip")
    assert failure.__cause__.code == "file_exists" and "one.zip" in str(failure)


def changed(source: Path, target: Path, change) -> Path:
    """Copy a backup; ``change`` gets name and bytes of each member, and returns new bytes or None."""
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(target, "w") as new:
        for name in old.namelist():
            data = change(name, old.read(name))
            if data is not None:
                new.writestr(name, data)
    return target


def without_worlds(name, data):
    return None if name == "rows/annotations.world.jsonl" else data


def other_description(name, data):
    is_world = name == "rows/annotations.world.jsonl"
    return data.replace(b"home", b"homo") if is_world else data


def fewer_rows(name, data):
    return data[: data.rindex(b"[")] if name == "rows/annotations.command.jsonl" else data


def other_weights(name, data):
    return data + b"x" if name.startswith("files/") else data


def outside(name, data):
    return data.replace(b'"runs/', b'"../runs/') if name == NAME else data


@pytest.mark.parametrize(
    "change", [without_worlds, other_description, fewer_rows, other_weights, outside]
)
def test_a_damaged_backup_changes_nothing(change, small, var, tmp_path):
    before = backup_of(tmp_path / "one.zip")
    damaged = changed(tmp_path / "one.zip", tmp_path / "two.zip", change)
    with pytest.raises(Refusal) as refused:
        restore(damaged, replace=True)
    assert refused.value.code == "backup_damaged"
    assert backup_of(tmp_path / "three.zip") == before


WRONG_MANIFESTS = {
    "unknown key": lambda values: {**values, "comment": "mine"},
    "key left out": lambda values: {k: v for k, v in values.items() if k != "missing"},
    "no version": lambda values: {k: v for k, v in values.items() if k != "version"},
    "next version": lambda values: {**values, "version": 2},
    "version of another kind": lambda values: {**values, "version": ["1"]},
    "a list": lambda values: [values],
    "nothing": lambda values: None,
    "tables are a list": lambda values: {**values, "tables": []},
    "files are a text": lambda values: {**values, "files": "none"},
    "a part is a number": lambda values: {**values, "files": {"runs/1/weights": 1}},
    "a part has another key": lambda values: {
        **values,
        "files": {"runs/1/weights": {"bytes": 1, "sha256": "", "rows": None, "mode": 7}},
    },
    "rows are negative": lambda values: {
        **values,
        "tables": {name: {**part, "rows": -1} for name, part in values["tables"].items()},
    },
    "a moment that is a path": lambda values: {**values, "created_at": "../../elsewhere"},
    "no migrations": lambda values: {**values, "migrations": {}},
    "migrations of numbers": lambda values: {**values, "migrations": {"annotations": 25}},
    "an empty name": lambda values: {**values, "files": {"": values["files"].popitem()[1]}},
    "nested": lambda values: json.loads("[" * 900 + "]" * 900),
}


@pytest.mark.parametrize("change", WRONG_MANIFESTS.values(), ids=WRONG_MANIFESTS)
def test_a_manifest_that_nobody_wrote_is_refused_with_a_sentence(change, small, var, tmp_path):
    before = backup_of(tmp_path / "one.zip")
    odd = changed(
        tmp_path / "one.zip",
        tmp_path / "two.zip",
        lambda name, data: json.dumps(change(json.loads(data))).encode() if name == NAME else data,
    )
    _, failure = run("restore", odd, "--replace")
    assert failure.returncode == 1 and str(failure).endswith((".", "upgrade."))
    assert backup_of(tmp_path / "three.zip") == before


@pytest.mark.parametrize("manifest", [b"[" * 100_000, b"\xff", b"{", b"", b"NaN"], ids=len)
def test_a_manifest_that_is_no_json_is_refused(manifest, small, tmp_path):
    with zipfile.ZipFile(tmp_path / "x.zip", "w") as archive:
        archive.writestr(NAME, manifest)
    _, failure = run("restore", tmp_path / "x.zip")
    assert failure.__cause__.code == "no_backup"


def test_a_backup_of_another_version_is_refused(small, tmp_path):
    write_backup(tmp_path / "one.zip")
    newest = b'"parser_service": "0'
    other = changed(
        tmp_path / "one.zip",
        tmp_path / "two.zip",
        lambda name, data: data.replace(newest, newest + b"9") if name == NAME else data,
    )
    with pytest.raises(Refusal) as refused:
        restore(other, replace=True)
    assert refused.value.code == "other_version"


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04", b"no zip at all"])
def test_what_is_no_backup_is_refused(content, transactional_db, tmp_path):
    (tmp_path / "x.zip").write_bytes(content)
    _, failure = run("restore", tmp_path / "x.zip")
    assert failure.__cause__.code == "no_backup" and "x.zip" in str(failure)


def test_an_archive_of_one_world_is_no_backup(transactional_db, tmp_path):
    with zipfile.ZipFile(tmp_path / "x.zip", "w") as archive:
        archive.writestr("world.json", "{}")
    _, failure = run("restore", tmp_path / "x.zip")
    assert failure.__cause__.code == "no_backup"


def test_every_table_of_ours_is_in_it(db):
    held = {table.model._meta.db_table for table in tables()}
    there = {
        name
        for name in connection.introspection.table_names()
        if name.startswith(("annotations_", "parser_service_"))
    }
    left_out = {"annotations_loginsession", "annotations_user_groups"}
    assert there - held == {*left_out, "annotations_user_user_permissions"}
