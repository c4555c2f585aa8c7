"""manage.py export_world W --output F, and import_world F --world W"""

from __future__ import annotations

from annotations.models import World
from tests.annotations.commands.run_command import run
from tests.annotations.exchange.packing import everything_of


def test_a_world_moves_by_a_file(tiny_world, tmp_path):
    report, failure = run("export_world", "home", "--output", tmp_path / "home.zip")
    assert failure is None and report["bytes"] > 1000
    report, failure = run("import_world", tmp_path / "home.zip", "--world", "again")
    assert failure is None and report["rows"]["templates"] == 2
    assert everything_of(World.objects.get(name="again")) == everything_of(tiny_world)


def test_a_file_that_is_not_there(db, tmp_path):
    _, failure = run("import_world", tmp_path / "none.zip", "--world", "again")
    assert "none.zip" in str(failure)
    assert failure.returncode == 1


def test_a_world_that_is_not_there(world, tmp_path):
    _, failure = run("export_world", "nowhere", "--output", tmp_path / "x.zip")
    assert "“nowhere”" in str(failure) and ": home." in str(failure)
