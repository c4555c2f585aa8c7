"""manage.py expand_grammar NAME --category C --json"""

from __future__ import annotations

from annotations.exchange.generator_import import import_generator
from tests.annotations.commands.run_command import run


def test_2019_expands_to_the_commands_of_the_published_reader(db, shared_data):
    import_generator("gpsr2019", shared_data / "generator-2019")
    report, failure = run("expand_grammar", "gpsr2019", "--category", "gpsr")
    assert failure is None
    assert report["commands"] == 14520
    assert report["size"] >= 14520


def test_ten_to_the_twelfth_is_refused_at_once_with_its_size(db):
    digits = " | ".join("abcdefghij")
    files = {"huge.txt": f"$Main = {' '.join(['$d'] * 12)}\n$d = {digits}\n".encode()}
    import_generator("huge", files)
    report, failure = run("expand_grammar", "huge", "--category", "huge")
    assert report == {"size": 10**12, "commands": None}
    assert "1,000,000,000,000" in str(failure)


def test_the_limit_is_the_callers(tiny_world):
    report, failure = run("expand_grammar", "home", "--category", "1", "--limit", "2")
    assert (report["size"], report["commands"]) == (3, None)
    assert failure.returncode == 1
    assert run("expand_grammar", "home", "--category", "1", "--limit", "3")[0]["commands"] == 3


def test_an_unknown_world_or_category_is_answered_with_those_that_exist(tiny_world):
    _, failure = run("expand_grammar", "home", "--category", "gpsr")
    assert "“gpsr”" in str(failure) and ": 1." in str(failure)
    _, failure = run("expand_grammar", "away", "--category", "1")
    assert "“away”" in str(failure) and ": home." in str(failure)
