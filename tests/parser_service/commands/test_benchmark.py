"""``manage.py benchmark``: cells over a folder of pair files."""

from __future__ import annotations

from itertools import groupby

import pytest
from django.core.management import CommandError

from parser_service.benchmarking import benchmark_cells as cells_module
from parser_service.benchmarking.trials import trials
from parser_service.management.options import read_column
from parser_service.parsers.conditions import PAPERS_SETTINGS
from tests.parser_service.commands.benchmark_run import run
from tests.parser_service.llm_server import KEY, REPORTED, fails, installed_tiny_server, says

KEYS = {
    "parser", "configuration", "setting", "criterion", "protocol", "seed", "n_train", "n_test",
    "accuracy_validation", "accuracy_test", "well_formed", "seconds_train",
    "milliseconds_per_command", "parameters", "code_version",
}  # fmt: skip


def test_a_cell_says_all_that_the_table_needs(folder, tmp_path):
    cells = run(folder, tmp_path / "cells.json")
    assert {cell["setting"] for cell in cells} == set(map(str, PAPERS_SETTINGS))
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
        cells_module, "_fit", lambda trial, *rest: fits.append(trial) or fit(trial, *rest)
    )
    cells = run(folder, tmp_path / "cells.json", seeds="2")
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
    todo = list(trials(["ranker", "knn"], [read_column(text) for text in texts], [0, 1]))
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
        options["seeds"] = "2"
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


def test_a_cell_names_the_model_that_answered_and_one_without_all_answers_is_not_measured(
    folder, tmp_path
):
    asked = {"parsers": "llm", "columns": "gen-para:command:strict"}
    with installed_tiny_server(tmp_path) as tiny:
        with pytest.raises(CommandError, match=r"\bmodel\b"):
            run(folder, tmp_path / "cells.json", **asked)
        tiny.faults = [*4 * [says('{"form": "UNKNOWN"}')], *9 * [fails(500, KEY)]]
        asked["config"] = ["llm.model=tiny", "llm.at_once=1"]
        with pytest.raises(CommandError, match=r"\b500\b"):
            run(folder, tmp_path / "cells.json", **asked)
        assert not (tmp_path / "cells.json").exists()
        tiny.faults.clear()
        before = len(tiny.asked)
        [cell] = run(folder, tmp_path / "cells.json", **asked)
    assert (cell["answered_by"], cell["n_validation"]) == (REPORTED, 9)
    assert len(tiny.asked) == before + 9 - 3  # the first of the four was asked in fitting
    assert KEY not in (tmp_path / "cells.json").read_text()
