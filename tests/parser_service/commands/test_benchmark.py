"""``manage.py benchmark``: cells over a folder of pair files."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from itertools import groupby
from pathlib import Path

import pytest
from django.conf import settings as site
from django.core.management import CommandError, call_command

from annotations.importing import import_generator
from parser_service.benchmarking import cells as cells_module
from parser_service.benchmarking.corpus import new_split, read_corpus, source_commands
from parser_service.management.options import read_column, read_split_seeds
from parser_service.parsers.conditions import SETTINGS
from tests.parser_service.llm_server import (
    KEY,
    REPORTED,
    fails,
    installed_tiny_server,
    says,
)
from tests.parser_service.made_up import made_up_pairs, make_folder
from tests.parser_service.worker_process import ROOT

KEYS = {
    "parser", "configuration", "setting", "criterion", "protocol", "seed", "n_train", "n_test",
    "accuracy_validation", "accuracy_test", "well_formed", "seconds_train",
    "milliseconds_per_command", "parameters", "code_version",
}  # fmt: skip


@pytest.fixture
def folder(tmp_path) -> Path:
    return make_folder(tmp_path / "pairs")


def run(folder: Path, file: Path, **options) -> list[dict]:
    named = {} if "columns" in options else {"criteria": "command", "protocols": "strict"}
    call_command("benchmark", str(folder), json=file, **{"parsers": "knn", **named, **options})
    return json.loads(file.read_text(encoding="utf-8"))


def test_a_cell_says_all_that_the_table_needs(folder, tmp_path):
    cells = run(folder, tmp_path / "cells.json")
    assert {cell["setting"] for cell in cells} == set(map(str, SETTINGS))
    for cell in cells:
        assert cell.keys() >= KEYS
        assert 0 <= cell["accuracy_validation"] <= 1
        assert (cell["accuracy_test"], cell["n_test"]) == (None, 0)
        assert cell["milliseconds_per_command"] > 0


def test_train_and_test_sources_are_those_of_the_setting(folder, tmp_path):
    counts = {
        cell["setting"]: (cell["n_train"], cell["n_validation"])
        for cell in run(folder, tmp_path / "cells.json")
    }
    assert counts == {
        "gen-gen": (27, 9),
        "gen-para": (27, 9),
        "para-para": (27, 9),
        "gen+para-para": (54, 9),
        "gen+para-mixed": (54, 18),
    }


def test_cells_are_appended_and_measured_once(folder, tmp_path, monkeypatch):
    file = tmp_path / "cells.json"
    first = run(folder, file, train_test="gen-gen")
    assert len(first) == 1
    both = run(folder, file, train_test="gen-gen,para-para")
    assert both[0] == first[0]
    assert [cell["setting"] for cell in both] == ["gen-gen", "para-para"]
    monkeypatch.setattr(cells_module, "measure_cell", None)
    assert run(folder, file, train_test="gen-gen,para-para") == both


def test_settings_that_train_alike_share_one_training(folder, tmp_path, monkeypatch):
    fits = []
    fit = cells_module._fit
    monkeypatch.setattr(
        cells_module, "_fit", lambda job, *rest: fits.append(job) or fit(job, *rest)
    )
    cells = run(folder, tmp_path / "cells.json", seeds=2)
    assert len(cells) == 10 and len(fits) == 6
    alike = [cell for cell in cells if cell["setting"].startswith("gen+para-") and not cell["seed"]]
    assert alike[0]["seconds_train"] == alike[1]["seconds_train"]


def test_columns_are_measured_and_no_other_combination(folder, tmp_path):
    columns = "gen+para-mixed:command:strict, gen-gen:command:strict,para-para:command:domain"
    cells = run(folder, tmp_path / "cells.json", columns=columns)
    columns_of_cells = [(cell["setting"], cell["criterion"], cell["protocol"]) for cell in cells]
    assert columns_of_cells == [
        ("gen-gen", "command", "strict"),
        ("gen+para-mixed", "command", "strict"),
    ]


def test_columns_that_train_alike_stand_together():
    texts = (
        "gen+para-para:command:strict", "gen-gen:command:strict", "gen+para-para:command:domain",
        "gen+para-mixed:logical_form:strict", "gen+para-mixed:command:strict",
        "gen-para:command:strict", "gen+para-para:logical_form:strict",
    )  # fmt: skip
    todo = list(cells_module.jobs(["ranker", "knn"], [read_column(text) for text in texts], 2))
    assert len(todo) == len(set(todo)) == 2 * (7 + 6)
    trainings = [training for training, _ in groupby(todo, key=lambda job: job.training)]
    assert len(trainings) == len(set(trainings)) == 2 * (4 + 3)


@pytest.mark.parametrize("change", ["code", "configuration", "seed", "pairs"])
def test_whatever_decides_a_cell_makes_another_one(folder, tmp_path, monkeypatch, change):
    file = tmp_path / "cells.json"
    run(folder, file, train_test="gen-gen")
    options = {"train_test": "gen-gen"}
    if change == "code":
        monkeypatch.setattr(cells_module, "code_version", lambda: "another")
    elif change == "configuration":
        options["config"] = ["knn.least_overlap=0.5"]
    elif change == "seed":
        options["seeds"] = 2
    else:
        path = folder / "gen" / "train.txt"
        path.write_text(path.read_text().replace("bring me", "give me"), encoding="utf-8")
    assert len(run(folder, file, **options)) == 2


def test_a_test_part_is_scored_with_the_validation_pairs_as_neighbours(folder, tmp_path):
    (folder / "gen" / "test.txt").write_bytes((folder / "gen" / "val.txt").read_bytes())
    (cell,) = run(folder, tmp_path / "cells.json", train_test="gen-gen")
    assert cell["n_test"] == 9
    assert cell["accuracy_test"] == 1.0
    assert cell["accuracy_validation"] < 1.0


def split_by_source_command(folder):
    return new_split(folder, "source_command", 0, source_commands(folder, lambda prompt: prompt))


def test_no_source_command_is_in_two_parts(folder):
    corpus = split_by_source_command(folder)
    source = {said: command for command, said, _ in made_up_pairs()}
    parts: dict[str, set[str]] = {}
    for (part, _), pairs in corpus.parts.items():
        for pair in pairs:
            parts.setdefault(source.get(pair.utterance, pair.utterance), set()).add(part)
    assert len(parts) == 36
    assert all(len(some) == 1 for some in parts.values())
    assert {part for part, _ in corpus.parts} == {"train", "validation", "test"}


def test_a_paraphrase_of_unknown_origin_is_left_out(folder):
    (folder / "paraphrasings.txt").write_text(
        "".join((folder / "paraphrasings.txt").read_text().splitlines(keepends=True)[:30])
    )
    corpus = split_by_source_command(folder)
    sources = [pair.source for pairs in corpus.parts.values() for pair in pairs]
    assert (sources.count("generated"), sources.count("paraphrased")) == (36, 10)


@pytest.mark.parametrize("criterion", ["command", "source_command", "logical_form"])
def test_new_splits_stand_in_for_the_published_one(folder, tmp_path, criterion, world):
    for name in ("gen", "para"):
        shutil.copytree(folder / name, folder / f"{name}_logical")
    options = {"criteria": criterion, "train_test": "para-para", "world": "home"}
    cells = run(folder, tmp_path / "cells.json", new_splits="2-4", **options)
    assert [(cell["split"], cell["seed"]) for cell in cells] == [(2, 0), (3, 0), (4, 0)]
    for cell in cells:
        assert (cell["n_train"], cell["n_validation"], cell["n_test"]) == pytest.approx(
            (25, 4, 7), abs=3
        )
    published = run(folder, tmp_path / "others.json", **options)
    assert [cell["split"] for cell in published] == [0 if criterion == "source_command" else None]


def test_new_splits_are_so_many_or_those_of_some_seeds():
    assert list(read_split_seeds("3")) == [0, 1, 2]
    assert list(read_split_seeds(" 6-7 ")) == [6, 7]
    assert not read_split_seeds("0")


def test_no_form_is_in_two_parts_of_a_new_split(folder):
    for name in ("gen", "para"):
        (folder / name).rename(folder / f"{name}_logical")
    corpora = [new_split(folder, "logical_form", seed) for seed in range(2)]
    assert corpora[0] != corpora[1]
    for corpus in corpora:
        parts: dict[str, set[str]] = {}
        for (part, _), pairs in corpus.parts.items():
            for pair in pairs:
                parts.setdefault(pair.form, set()).add(part)
        assert all(len(some) == 1 for some in parts.values())


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"parsers": "knn,elmo"}, "'elmo' is not one of grammar-oracle, knn"),
        ({"train_test": "para-gen"}, "'para-gen' is not one of gen-gen"),
        ({"criteria": "logical_form"}, "has no split by logical_form"),
        ({"criteria": "source_command"}, "needs the ontology of a --world"),
        ({"columns": "para-gen:command:strict"}, "'para-gen' is not one of gen-gen"),
        ({"columns": "gen-gen:form:strict"}, "'form' is not one of command"),
        ({"columns": "gen-gen:command:loose"}, "'loose' is not one of strict"),
        (
            {"columns": "gen-gen:command"},
            "'gen-gen:command' has to be TRAIN-TEST:CRITERION:PROTOCOL",
        ),
        ({"columns": "gen-gen:command:strict", "criteria": "command"}, "leave either out"),
        ({"new_splits": "-1"}, "--new-splits is '-1'; it has to be a number of splits (5), or"),
        ({"new_splits": "9-6"}, "--new-splits is '9-6'; it has to be a number of splits (5), or"),
        ({"seeds": 0}, "--seeds is 0; it has to be 1 or more"),
        ({"jobs": 0}, "--jobs is 0; it has to be 1 or more"),
        ({"config": ["least_overlap=0.5"]}, "has to be PARSER.KEY=VALUE"),
        ({"parsers": "grammar-oracle", "protocols": "grammar"}, "The grammar oracle parses with"),
    ],
)
def test_bad_input_is_a_sentence(folder, tmp_path, options, sentence):
    with pytest.raises(CommandError) as refused:
        run(folder, tmp_path / "cells.json", **options)
    assert sentence in str(refused.value)


def test_a_broken_pair_file_is_named_with_its_line(folder, tmp_path):
    with (folder / "gen" / "val.txt").open("a") as file:
        file.write("one line too many\n")
    with pytest.raises(CommandError, match=r"val\.txt:19:1: .*not a multiple of 2"):
        run(folder, tmp_path / "cells.json")


def test_a_file_that_holds_something_else_is_not_overwritten(folder, tmp_path):
    file = tmp_path / "notes.json"
    file.write_text('{"note": 1}')
    with pytest.raises(CommandError, match="holds something other than cells"):
        run(folder, file)
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
    with pytest.raises(CommandError, match="unrecognized arguments: --set gen-gen"):
        call_command(*command.split(), "--set", "gen-gen")


def test_the_options_of_the_command_line_are_those_of_the_command(folder, tmp_path):
    file = tmp_path / "cells.json"
    command = ["manage.py", "benchmark", str(folder), "--parsers", "knn", "--json", str(file)]
    chosen = ["--train-test", "gen-gen", "--criteria=command"]
    environment = {**os.environ, "GPSR_VAR_DIR": str(site.VAR_DIR)}
    subprocess.run([sys.executable, *command, *chosen], cwd=ROOT, env=environment, check=True)
    assert [cell["setting"] for cell in json.loads(file.read_text())] == ["gen-gen"]


def test_the_oracle_is_right_on_every_published_generated_pair(shared_data, tmp_path, db):
    import_generator("gpsr2018", shared_data / "generator-2018")
    cells = run(
        shared_data / "walker2019",
        tmp_path / "cells.json",
        world="gpsr2018",
        parsers="grammar-oracle",
        protocols="grammar",
        criteria="command,logical_form",
        train_test="gen-gen",
    )
    assert [cell["accuracy_validation"] for cell in cells] == [1.0, 1.0]


def test_the_published_parts_have_the_published_sizes(shared_data):
    for criterion, sizes in (("command", (847, 121)), ("logical_form", (850, 129))):
        corpus = read_corpus(shared_data / "walker2019", criterion)
        parts = [corpus.pairs(part, ["generated"]) for part in ("train", "validation")]
        assert tuple(map(len, parts)) == sizes


def test_a_cell_names_the_model_that_answered_and_one_without_all_answers_is_not_measured(
    folder, tmp_path
):
    asked = {"parsers": "llm", "columns": "gen-para:command:strict"}
    with installed_tiny_server(tmp_path) as tiny:
        with pytest.raises(CommandError, match="model is empty"):
            run(folder, tmp_path / "cells.json", **asked)
        tiny.faults = [*4 * [says('{"form": "UNKNOWN"}')], *9 * [fails(500, KEY)]]
        asked["config"] = ["llm.model=tiny", "llm.at_once=1"]
        with pytest.raises(CommandError, match="does not answer: status 500"):
            run(folder, tmp_path / "cells.json", **asked)
        assert not (tmp_path / "cells.json").exists()
        tiny.faults.clear()
        before = len(tiny.asked)
        [cell] = run(folder, tmp_path / "cells.json", **asked)
    assert (cell["answered_by"], cell["n_validation"]) == (REPORTED, 9)
    assert len(tiny.asked) == before + 9 - 3  # the first of the four was asked in fitting
    assert KEY not in (tmp_path / "cells.json").read_text()
