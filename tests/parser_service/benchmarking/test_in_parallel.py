"""``manage.py benchmark --jobs N``: trainings side by side."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from django.conf import settings as site
from django.core.management import CommandError, call_command

from annotations.exchange.generator_import import import_generator
from parser_service.benchmarking.benchmark_cells import TrialGroup
from parser_service.benchmarking.corpus import read_corpus
from parser_service.benchmarking.in_parallel import measure_in_parallel
from parser_service.benchmarking.trials import trials
from parser_service.management.options import read_column
from parser_service.parsers.interface import Knowledge
from tests.parser_service.made_up import TINY, make_folder
from tests.parser_service.worker_process import ROOT
from tests.waiting import PATIENCE_SECONDS, wait_for

DURATIONS = ("seconds_train", "milliseconds_per_command")
ALIKE = "gen+para-para:command:strict,gen+para-mixed:command:strict"
COLUMNS = f"gen-gen:command:strict,{ALIKE}"


@pytest.fixture
def folder(tmp_path) -> Path:
    return make_folder(tmp_path / "pairs")


@pytest.fixture
def file(tmp_path) -> Path:
    return tmp_path / "cells.json"


def read(file: Path) -> dict[str, dict]:
    """The cells by their keys, none twice."""
    cells = json.loads(file.read_text(encoding="utf-8"))
    cell_of = {cell["key"]: cell for cell in cells}
    assert len(cell_of) == len(cells)
    return cell_of


def without_durations(cells: dict[str, dict]) -> dict[str, dict]:
    return {
        key: {name: value for name, value in cell.items() if name not in DURATIONS}
        for key, cell in cells.items()
    }


def measure(folder: Path, file: Path, **options) -> dict[str, dict]:
    given = {"parsers": "knn", "columns": COLUMNS, "seeds": "3", **options}
    call_command("benchmark", str(folder), json=file, **given)
    return read(file)


@pytest.fixture
def started(folder, file):
    """The command as a process with a group of its own, which is gone when the test is over.

    It has more to do than it can finish before it is stopped.
    """
    process = subprocess.Popen(
        [
            *(sys.executable, "manage.py", "benchmark", str(folder), "--json", str(file)),
            *("--parsers", "knn", "--columns", COLUMNS, "--seeds", "300", "--jobs", "2"),
        ],
        cwd=ROOT,
        env={**os.environ, "GPSR_VAR_DIR": str(site.VAR_DIR)},
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    yield process
    if is_running(process):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def is_running(process: subprocess.Popen) -> bool:
    """Whether anything is left of the command: itself or a process that it started."""
    try:
        os.killpg(process.pid, 0)
    except ProcessLookupError:
        return False
    return True


def test_the_cells_are_those_of_one_process(folder, file, tmp_path):
    side_by_side = measure(folder, file, jobs=2)
    alone = measure(folder, tmp_path / "alone.json")
    assert len(alone) == 9
    assert without_durations(side_by_side) == without_durations(alone)


def test_a_network_is_trained_once_for_two_columns_and_answers_as_in_one_process(
    folder, file, tmp_path
):
    tiny = [f"seq2seq.{name}={value}" for name, value in {**TINY, "epochs": 2}.items()]
    asked = {"parsers": "seq2seq", "config": tiny, "columns": ALIKE, "seeds": "1"}
    side_by_side = measure(folder, file, jobs=2, **asked)
    first, second = (cell["seconds_train"] for cell in side_by_side.values())
    assert first == second > 0
    alone = measure(folder, tmp_path / "alone.json", **asked)
    assert without_durations(side_by_side) == without_durations(alone)


def test_a_process_knows_what_its_protocol_allows(shared_data, file, db):
    import_generator("gpsr2018", shared_data / "generator-2018")
    columns = "gen-gen:command:grammar,gen-gen:logical_form:grammar"
    asked = {"world": "gpsr2018", "parsers": "grammar-oracle", "columns": columns, "seeds": "1"}
    cells = measure(shared_data / "walker2019", file, jobs=2, **asked)
    assert [cell["accuracy_validation"] for cell in cells.values()] == [1.0, 1.0]


@pytest.mark.processes
def test_what_was_measured_before_a_kill_is_not_measured_again(folder, file, started):
    wait_for(file.exists, "the first cell")
    started.kill()
    started.wait()
    wait_for(lambda: not is_running(started), "the processes end with their parent")
    before = read(file)
    after = measure(folder, file, jobs=2)
    assert len(after) >= 9
    assert {key: after[key] for key in before} == before


@pytest.mark.processes
def test_an_interrupt_ends_all_processes_and_leaves_a_whole_file(file, started):
    wait_for(file.exists, "the first cell")
    os.killpg(started.pid, signal.SIGINT)  # As Ctrl-C in a terminal: to all processes of it.
    _, said = started.communicate(timeout=PATIENCE_SECONDS)
    assert started.returncode == 1
    assert said == (
        f"CommandError: Stopped. {file} keeps the cells that were finished; the same command "
        "measures the others.\n"
    )
    wait_for(lambda: not is_running(started), "no process is left")
    assert 0 < len(read(file)) < 900


def test_what_cannot_be_measured_is_said_and_the_rest_is_measured(folder, file):
    columns = f"gen-gen:logical_form:strict,{COLUMNS}"
    with pytest.raises(CommandError, match="logical_form"):
        measure(folder, file, columns=columns, jobs=2, seeds="1")
    assert len(read(file)) == 3


def test_a_refusal_of_the_parser_itself_is_a_sentence(folder, file):
    asked = {"parsers": "grammar-oracle,knn", "columns": f"gen-gen:command:grammar,{COLUMNS}"}
    with pytest.raises(CommandError) as refused:
        measure(folder, file, jobs=2, seeds="1", **asked)
    assert str(refused.value).startswith("grammar-oracle, grammar: ")
    assert len(read(file)) == 3


class Killed(TrialGroup):
    """A group whose process is killed after its first cell."""

    def measure(self):
        yield next(super().measure())
        os.kill(os.getpid(), signal.SIGKILL)


def test_a_process_that_dies_is_a_sentence_for_each_cell_that_it_owes(folder):
    todo = tuple(trials(["knn"], [read_column(text) for text in ALIKE.split(",")], seeds=[0]))
    known = (read_corpus(folder, "command"), Knowledge(), "")
    answers = list(measure_in_parallel([Killed(todo, *known), TrialGroup(todo, *known)], 2))
    sentences = [answer for answer in answers if isinstance(answer, str)]
    assert len(answers) == 4
    assert sentences == [
        "knn, strict: the process that measured knn gen+para-para, gen+para-mixed by command was "
        "killed by SIGKILL. Measure again what is missing, with a smaller --jobs where memory ran "
        "short."
    ]
