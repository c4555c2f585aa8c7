"""manage.py import_generator DIR --world NAME --json"""

from __future__ import annotations

import pytest
from django.core.management import call_command

from annotations.editing.edits import delete
from annotations.models import World
from tests.annotations.commands.bad_inputs import FAULTS
from tests.annotations.commands.run_command import run
from tests.annotations.rows_of import counts, rows_of


def test_the_report_is_one_object_with_the_documented_keys(db, tiny_folder):
    report, failure = run("import_generator", tiny_folder, "--world", "new")
    assert failure is None
    assert report["templates"] == {"1": 2}
    assert report["productions"] == {"common_rules.txt": 2, "tiny_category_1_grammar.txt": 2}
    assert report["entities"] == {"category": 1, "object": 2, "room": 2, "location": 2}
    assert report["problems"] == []


def test_a_problem_has_its_place_and_a_hint(db, tiny_folder):
    with (tiny_folder / "common_rules.txt").open("a") as file:
        file.write("$vbfind = spot | $nowhere\n")
    report, _ = run("import_generator", tiny_folder, "--world", "new")
    problem = next(each for each in report["problems"] if "$nowhere" in each["message"])
    assert problem["hint"]
    assert {key: problem[key] for key in ("file", "line", "column", "severity")} == {
        "file": "common_rules.txt",
        "line": 4,
        "column": 18,
        "severity": "warning",
    }


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_refused_at_its_place_and_nothing_is_stored(tiny_world, tiny, tmp_path, name):
    fault, before = FAULTS[name], (counts(), rows_of(tiny_world))
    fault.put_into(tiny)
    for file, data in tiny.items():
        (tmp_path / file).write_bytes(data)
    report, failure = run("import_generator", tmp_path, "--world", tiny_world.name)
    errors = [each for each in report["problems"] if each["severity"] == "error"]
    assert any(
        (each["file"], each["line"]) == (fault.name, fault.line) and fault.cause in each["message"]
        for each in errors
    ), errors
    assert failure.returncode == 1
    assert (counts(), rows_of(tiny_world)) == before


def test_a_folder_that_is_not_there_is_refused(db, tmp_path):
    report, failure = run("import_generator", tmp_path / "nowhere", "--world", "new")
    (problem,) = report["problems"]
    assert (problem["file"], problem["severity"]) == ("nowhere", "error")
    assert failure.returncode == 1
    assert not World.objects.exists()


def test_a_link_out_of_the_folder_is_refused(db, tiny_folder, tmp_path_factory):
    outside = tmp_path_factory.mktemp("outside") / "secret.txt"
    outside.write_text("$Main = secret\n")
    (tiny_folder / "linked.txt").symlink_to(outside)
    report, failure = run("import_generator", tiny_folder, "--world", "new")
    (problem,) = report["problems"]
    assert (problem["file"], problem["severity"]) == ("linked.txt", "error")
    assert failure.returncode == 1 and not World.objects.exists()


def test_without_json_a_person_reads_figures_and_problems(db, tiny_folder, capsys):
    (tiny_folder / "notes.pdf").write_bytes(b"%PDF")
    call_command("import_generator", tiny_folder, "--world", "new")
    lines = capsys.readouterr().out.splitlines()
    assert "templates: 1 2" in lines
    assert lines[-1].startswith("  notes.pdf:1:1: warning: ")


def test_what_would_be_removed_is_named_and_needs_an_option(tiny_world, tiny_folder):
    (tiny_folder / "tiny_category_1_semantics.txt").unlink()
    arguments = ("import_generator", tiny_folder, "--world", tiny_world.name)
    before = rows_of(tiny_world)
    report, failure = run(*arguments)
    assert len(report["removals"]["templates"]) == 2 and report["is_waiting"]
    assert "go to the {room} = (go {room})" in str(failure)
    assert "--remove-missing" in str(failure)
    assert rows_of(tiny_world) == before
    report, failure = run(*arguments, "--remove-missing")
    assert failure is None and not tiny_world.grammar.templates.exists()


def test_what_people_deleted_is_left_out_unless_asked_for(tiny_world, tiny_folder, admin, capsys):
    template = tiny_world.grammar.templates.last()
    delete(template, admin, 1)
    call_command("import_generator", str(tiny_folder), world="home")
    assert (
        f"  left out: {template.source}: {template} (deleted by adam on" in capsys.readouterr().out
    )
    assert tiny_world.grammar.templates.count() == 1
    report, _ = run("import_generator", tiny_folder, "--world", "home", "--bring-back")
    assert report["left_out"]["templates"] == []
    assert tiny_world.grammar.templates.count() == 2


def test_the_name_of_a_world_is_normalised_as_everywhere(db, tiny_folder):
    for name in ("new", "ne\u200bw", "\ufeffnew"):
        _, failure = run("import_generator", tiny_folder, "--world", name)
        assert failure is None
    assert [world.name for world in World.objects.all()] == ["new"]
