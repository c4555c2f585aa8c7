"""Options and files that ``manage.py benchmark`` takes and refuses."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest
from django.conf import settings as site
from django.core.management import CommandError, call_command

from tests.parser_service.commands.benchmark_run import run
from tests.parser_service.worker_process import ROOT


@pytest.mark.parametrize(
    ("options", "code", "named"),
    [
        ({"parsers": "knn,elmo"}, "unknown_name", "'elmo'.* grammar-oracle, knn"),
        ({"train_test": "para-gen"}, "unknown_name", "'para-gen'.* gen-gen"),
        ({"criteria": "logical_form"}, None, "logical_form"),
        ({"criteria": "source_command"}, None, "--world"),
        ({"columns": "para-gen:command:strict"}, "unknown_name", "'para-gen'.* gen-gen"),
        ({"columns": "gen-gen:form:strict"}, "unknown_name", "'form'.* command"),
        ({"columns": "gen-gen:command:loose"}, "unknown_name", "'loose'.* strict"),
        (
            {"columns": "gen-gen:command"},
            "column_unreadable",
            "'gen-gen:command'.*TRAIN-TEST:CRITERION:PROTOCOL",
        ),
        (
            {"columns": "gen-gen:command:strict", "criteria": "command"},
            "options_contradict",
            "--columns",
        ),
        ({"new_splits": "-1"}, "seeds_unreadable", "--new-splits.*'-1'.* 0 "),
        ({"new_splits": "9-6"}, "seeds_unreadable", "--new-splits.*'9-6'.* 0 "),
        ({"seeds": "0"}, "seeds_unreadable", "--seeds.*'0'.* 1 "),
        ({"jobs": 0}, "option_out_of_range", "--jobs.* 0.* 1 "),
        ({"config": ["least_overlap=0.5"]}, "hyperparameter_unreadable", "PARSER.KEY=VALUE"),
        ({"parsers": "grammar-oracle", "protocols": "grammar"}, None, "^grammar-oracle, grammar: "),
    ],
)
def test_bad_input_is_told_by_a_code_and_its_name(folder, tmp_path, options, code, named):
    with pytest.raises(CommandError, match=named) as refused:
        run(folder, tmp_path / "cells.json", **options)
    assert getattr(refused.value.__cause__, "code", None) == code


def test_a_file_of_cells_that_cannot_be_read_is_named(folder, tmp_path):
    with pytest.raises(CommandError) as refused:
        run(folder, tmp_path)
    assert str(tmp_path) in str(refused.value) and "Errno" not in str(refused.value)


def test_a_broken_pair_file_is_named_with_its_line(folder, tmp_path):
    with (folder / "gen" / "val.txt").open("a") as file:
        file.write("one line too many\n")
    with pytest.raises(CommandError, match=r"val\.txt:19:1: .*\b2\b"):
        run(folder, tmp_path / "cells.json")


def test_a_file_that_holds_something_else_is_not_overwritten(folder, tmp_path):
    file = tmp_path / "notes.json"
    file.write_text('{"note": 1}')
    with pytest.raises(CommandError, match=r"notes\.json") as refused:
        run(folder, file)
    assert refused.value.__cause__.code == "not_a_cells_file"
    assert file.read_text() == '{"note": 1}'


@pytest.mark.parametrize(
    "command",
    [
        "benchmark pairs --json cells.json",
        "train knn --world home --split home",
        "parse hello --world home",
    ],
)
def test_an_abbreviated_option_is_refused_and_not_taken_for_the_settings_module(command):
    with pytest.raises(CommandError, match="--set gen-gen"):
        call_command(*command.split(), "--set", "gen-gen")


def test_the_options_of_the_command_line_are_those_of_the_command(folder, tmp_path):
    file = tmp_path / "cells.json"
    command = ["manage.py", "benchmark", str(folder), "--parsers", "knn", "--json", str(file)]
    chosen = ["--train-test", "gen-gen", "--criteria=command"]
    environment = {**os.environ, "GPSR_VAR_DIR": str(site.VAR_DIR)}
    subprocess.run([sys.executable, *command, *chosen], cwd=ROOT, env=environment, check=True)
    assert [cell["setting"] for cell in json.loads(file.read_text())] == ["gen-gen"]
