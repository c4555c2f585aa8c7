"""The commands as processes: streams, exit status, no traceback."""

from __future__ import annotations

import json
import sqlite3

import pytest

from tests.annotations.commands.bad_inputs import FAULTS
from tests.annotations.commands.run_command import run_process
from tests.migrated import copy_installation


@pytest.fixture(scope="module")
def var_dir(migrated_database, tmp_path_factory):
    """A fresh installation's folder, its database migrated."""
    return copy_installation(migrated_database, tmp_path_factory.mktemp("var"))


def test_2018_imports_and_generates(var_dir, shared_data):
    folder = shared_data / "generator-2018"
    imported = run_process(var_dir, "import_generator", folder, "--world", "gpsr2018", "--json")
    generated = run_process(var_dir, "generate_pairs", "gpsr2018", "--json")
    assert (imported.returncode, imported.stderr) == (0, "")
    assert json.loads(imported.stdout)["templates"] == {"1": 28, "2": 53, "3": 44}
    assert json.loads(generated.stdout)["commands"]["all"] == 1211


@pytest.mark.parametrize(
    "name", ["a cycle", "a form 1,000 deep", "an entity bomb", "a UTF-16 file"]
)
def test_a_refused_import_prints_its_object_a_sentence_and_status_1(var_dir, tiny, tmp_path, name):
    fault = FAULTS[name]
    fault.put_into(tiny)
    for file, data in tiny.items():
        (tmp_path / file).write_bytes(data)
    answer = run_process(var_dir, "import_generator", tmp_path, "--world", "bad", "--json")
    assert answer.returncode == 1
    assert any(each["file"] == fault.name for each in json.loads(answer.stdout)["problems"])
    assert "Traceback" not in answer.stderr
    assert f"{fault.name}:{fault.line}" in answer.stderr
    with sqlite3.connect(var_dir / "db.sqlite3") as database:
        query = "SELECT count(*) FROM annotations_world WHERE name = 'bad'"
        assert database.execute(query).fetchone() == (0,)


def test_a_database_without_tables_is_a_sentence(tmp_path):
    answer = run_process(tmp_path, "generate_pairs", "home", "--json")
    assert answer.returncode == 1
    assert "migrate" in answer.stderr
    assert "Traceback" not in answer.stderr
    assert answer.stdout == ""
