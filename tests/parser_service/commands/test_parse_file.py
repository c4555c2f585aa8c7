"""``manage.py parse --file``: an answer to every line, by a run or by the grammar oracle without one."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from io import StringIO

import pytest
from django.core.management import CommandError, call_command

from annotations.exchange.generator_import import import_generator
from tests.annotations.commands.run_command import ROOT, run_process
from tests.annotations.conftest import TINY, as_bytes
from tests.migrated import copy_installation
from tests.parser_service.served import make_home, trained_run

ORACLE = ("--parser", "grammar-oracle")
LINES = """\
find the tea

{"command": "go to the bath", "kinds": ["goToLoc"]}
{"utterance": "locate the milk", "command": "find the milk"}
sing a song
"""
GO = '( go " bath " )'


@pytest.fixture
def home(world):
    assert not import_generator(world.name, as_bytes(TINY)).problems
    return world


@pytest.fixture
def ask(tmp_path):
    """Returns a function that parses lines from a file: the answers, and the code of the refusal, if any."""

    def parse(lines: str, *options: str) -> tuple[list[dict], str]:
        file = tmp_path / "lines.txt"
        file.write_text(lines, encoding="utf-8")
        out, code = StringIO(), ""
        command = ("parse", "--file", str(file), "--world", "home", *options, "--json")
        try:
            call_command(*command, stdout=out)
        except CommandError as error:
            code = error.__cause__.code
        return [json.loads(line) for line in out.getvalue().splitlines()], code

    return parse


def test_every_line_is_answered_in_its_place(home, ask):
    answers, code = ask(LINES, *ORACLE)
    assert code == ""
    said = ["find the tea", "", "go to the bath", "locate the milk", "sing a song"]
    assert [each["utterance"] for each in answers] == said
    assert [each["is_unknown"] for each in answers] == [False, True, False, False, True]
    assert {(each["run"], each["parser"]) for each in answers} == {(None, "grammar-oracle")}
    assert answers[2]["candidates"][0]["grounded"] == GO
    assert answers[1]["candidates"] == answers[4]["candidates"] == []


def test_a_line_that_cannot_be_parsed_is_answered_and_the_status_says_so(home, ask):
    answers, code = ask(f'{{"utterance"\n{LINES}{{"utterance": 7}}\n', *ORACLE)
    assert code == "lines_refused"
    assert len(answers) == 7
    assert [each.get("line") for each in answers] == [1, None, None, None, None, None, 7]
    assert answers[0]["error"] and answers[6]["error"]
    assert answers[0].keys() - answers[1].keys() == {"line", "error"}
    assert answers[3]["candidates"][0]["grounded"] == GO


def test_one_line_is_answered_as_a_text_is(home, ask):
    out = StringIO()
    call_command("parse", "go to the bath", "--world", "home", *ORACLE, "--json", stdout=out)
    assert ask("go to the bath", *ORACLE) == ([json.loads(out.getvalue())], "")


def test_the_oracle_knows_the_world_as_it_is_now(home, ask):
    assert ask("find the cocoa", *ORACLE)[0][0]["is_unknown"]
    home.ontology.entities.create(entity_class="object", text="cocoa", position=99)
    assert not ask("find the cocoa", *ORACLE)[0][0]["is_unknown"]


def test_a_world_without_templates_has_no_oracle(world, ask):
    assert ask("find the tea", *ORACLE) == ([], "no_templates")


def test_a_run_answers_as_it_answers_alone(world, ask):
    run = trained_run(make_home(world))
    answers, _ = ask("find the bowl\n" * 40 + "\nbring me the red cup", "--run", str(run.pk))
    assert len(answers) == 42
    for number, text in ((0, "find the bowl"), (41, "bring me the red cup")):
        out = StringIO()
        call_command("parse", text, "--world", "home", "--run", str(run.pk), "--json", stdout=out)
        assert answers[number] == json.loads(out.getvalue())


def test_for_a_person_each_answer_is_text(home, tmp_path):
    file, out = tmp_path / "lines.txt", StringIO()
    file.write_text("go to the bath\n{\n")
    command = ("parse", "--file", str(file), "--world", "home", *ORACLE)
    with pytest.raises(CommandError):
        call_command(*command, stdout=out)
    assert "go(" in out.getvalue()
    assert "{" not in out.getvalue().partition("go(")[0]


@pytest.mark.parametrize("name", ["missing.txt", ".", "latin.txt"])
def test_a_file_that_cannot_be_read_is_a_sentence(home, tmp_path, name):
    (tmp_path / "latin.txt").write_bytes(b"find the caf\xe9\n")
    out = StringIO()
    with pytest.raises(CommandError):
        call_command(
            "parse", "--file", str(tmp_path / name), "--world", "home", *ORACLE, stdout=out
        )
    assert out.getvalue() == ""


@pytest.mark.parametrize(
    "options",
    [(), ("tea", "--file", "x"), ("tea", "--run", "1", *ORACLE), ("tea", "--parser", "knn")],
)
def test_options_that_do_not_go_together_are_refused(home, options):
    with pytest.raises(CommandError):
        call_command("parse", *options, "--world", "home")


@pytest.mark.processes
def test_a_pipe_is_answered_before_it_ends(migrated_database, tmp_path):
    """A process of its own, since it reads its standard input."""
    var = copy_installation(migrated_database, tmp_path / "var")
    folder = tmp_path / "files"
    folder.mkdir()
    for name, text in TINY.items():
        (folder / name).write_text(text, encoding="utf-8")
    assert run_process(var, "import_generator", folder, "--world", "home").returncode == 0
    command = [
        sys.executable, "manage.py", "parse", "--file", "-", "--world", "home", *ORACLE, "--json",
    ]  # fmt: skip
    environment = {**os.environ, "GPSR_VAR_DIR": str(var)}
    environment.pop("DATABASE_URL", None)
    with subprocess.Popen(
        command,
        cwd=ROOT,
        env=environment,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as process:
        for text in ("find the tea", "", "go to the bath"):
            process.stdin.write(f"{text}\n".encode())
            process.stdin.flush()
            assert json.loads(process.stdout.readline())["utterance"] == text
        process.stdin.write(b"\xff")
        process.stdin.close()
        assert json.loads(process.stdout.readline())["line"] == 4
        assert process.wait(60) == 1
