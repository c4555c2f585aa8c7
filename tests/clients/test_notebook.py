"""The notebook of the client runs, cell after cell, against a site and a parse server that run."""

from __future__ import annotations

import nbformat
import pytest
from django.core.management import call_command
from pytest_django.live_server_helper import LiveServer

from annotations.models import ApiToken, World
from parser_service.models import Prediction, TrainingRun
from tests.clients.conftest import CLIENT

NOTEBOOK = CLIENT / "examples" / "results.ipynb"


@pytest.fixture
def notebook() -> nbformat.NotebookNode:
    return nbformat.read(NOTEBOOK, as_version=4)


def test_it_is_a_notebook_without_outputs(notebook):
    nbformat.validate(notebook)
    codes = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert codes and not any(cell.outputs or cell.execution_count for cell in codes)


def test_it_shows_results_errors_and_answers(
    notebook, parse_server, live_server: LiveServer, annotator, world: World, tmp_path, monkeypatch
):
    split = world.splits.get()
    call_command("train", "knn", "--world", "home", "--split", split.name, "--seed", "9", "--json")
    run = TrainingRun.objects.latest("id")
    scores = run.evaluations.filter(part="validation", test_source="para")
    scores.update(accuracy=0.75)
    _, token = ApiToken.issue(annotator, "notebook", scope="read")
    for name, value in (("URL", live_server.url), ("WORLD", "home"), ("TOKEN", token)):
        monkeypatch.setenv(f"GPSR_{name}", value)
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for cell in notebook.cells:
        if cell.cell_type == "code":
            exec(compile(cell.source, f"{NOTEBOOK.name}:{cell.id}", "exec"), names)
    results, errors, answers = (names[name] for name in ("results", "errors", "answers"))
    shown = results[results["run_id"] == run.pk].set_index("test_source")["percent"]
    assert shown["para"] == 75
    wrong = Prediction.objects.filter(run=run, rank=1, is_exact_match=False)
    assert sorted(errors["logical_form"]) == sorted(wrong.values_list("logical_form", flat=True))
    assert answers["decision"].notna().all() and len(answers) == len(names["said"])


def test_the_rows_of_all_pages_come(parse_server, live_server: LiveServer, annotator, world: World):
    from gpsr_client import Workbench

    _, token = ApiToken.issue(annotator, "notebook", scope="read")
    home = Workbench(live_server.url, "home", token)
    texts = [row["text"] for row in home.rows("entities/", limit=1, sort="text")]
    assert len(texts) > 2
    assert texts == sorted(world.ontology.entities.values_list("text", flat=True))
