"""``manage.py export_run``: MLflow and TensorBoard read what it writes."""

from __future__ import annotations

import json
import sys
from io import StringIO

import pytest
from django.core.management import CommandError, call_command

from parser_service.models import EpochMetric, TrainingRun
from parser_service.results.run_logs import figures_of, parameters_of
from tests.parser_service.served import make_home, trained_run

LOSSES = [2.5, 1.25, 0.5]


@pytest.fixture
def run(world) -> TrainingRun:
    """A run with three epochs, of which the last measured no accuracy, and a score on paraphrases."""
    made = trained_run(make_home(world), spoken=0.75)
    for epoch, loss in enumerate(LOSSES, start=1):
        accuracy = None if epoch == len(LOSSES) else epoch / 10
        EpochMetric.objects.create(
            run=made, epoch=epoch, train_loss=loss, validation_accuracy=accuracy, seconds=1
        )
    return made


def export(run: TrainingRun, to: str, target: object) -> list[str]:
    out = StringIO()
    arguments = ("home", str(run.pk), "--to", to, "--output", str(target), "--json")
    call_command("export_run", *arguments, stdout=out)
    return json.loads(out.getvalue())["runs"]


def curves_of(run: TrainingRun) -> dict[str, list[tuple[int, float]]]:
    curves: dict[str, list[tuple[int, float]]] = {}
    for name, value, epoch in figures_of(run):
        curves.setdefault(name, []).append((epoch, pytest.approx(value)))
    return curves


def test_figures_are_curves_and_scores(run):
    curves = curves_of(run)
    assert curves["train/loss"] == [*enumerate(LOSSES, start=1)]
    assert curves["validation/accuracy"] == [(1, 0.1), (2, 0.2)]
    assert curves["validation/para/accuracy"] == [(3, 0.75)]
    assert "validation/loss" not in curves


def test_tensorboard_reads_the_events(run, tmp_path):
    events = pytest.importorskip(
        "tensorboard.backend.event_processing.event_accumulator",
        reason="needs the package tensorboard",
    )
    (folder,) = export(run, "tensorboard", tmp_path / "logs")
    read = events.EventAccumulator(folder)
    read.Reload()
    curves = {
        name: [(each.step, each.value) for each in read.Scalars(name)]
        for name in read.Tags()["scalars"]
    }
    assert curves == curves_of(run)
    (text,) = read.Tensors("parameters/text_summary")
    (written,) = text.tensor_proto.string_val
    listed = json.loads(written.decode().strip("`").removeprefix("json"))
    assert listed == json.loads(json.dumps(parameters_of(run)))


def test_mlflow_reads_the_run(run, tmp_path, monkeypatch):
    mlflow = pytest.importorskip("mlflow", reason="needs the package mlflow-skinny")
    monkeypatch.setenv("MLFLOW_ALLOW_FILE_STORE", "true")
    export(run, "mlflow", tmp_path / "mlruns")
    client = mlflow.MlflowClient(tracking_uri=(tmp_path / "mlruns").as_uri())
    experiment = client.get_experiment_by_name("home")
    (written,) = client.search_runs([experiment.experiment_id])
    assert written.info.status == "FINISHED"
    assert written.data.tags["gpsr.run"] == str(run.pk)
    assert written.data.tags["gpsr.split_hash"] == run.split.content_hash
    assert written.data.params == {name: str(value) for name, value in parameters_of(run).items()}
    curves = {
        name: [
            (each.step, each.value) for each in client.get_metric_history(written.info.run_id, name)
        ]
        for name in written.data.metrics
    }
    assert curves == curves_of(run)


@pytest.mark.parametrize(("to", "package"), [("mlflow", "mlflow"), ("tensorboard", "tensorboard")])
def test_a_run_is_written_once(run, tmp_path, to, package):
    pytest.importorskip(package, reason=f"needs the package {package}")
    export(run, to, tmp_path / "logs")
    with pytest.raises(CommandError, match=f"run {run.pk}"):
        export(run, to, tmp_path / "logs")


@pytest.mark.parametrize("to", ["mlflow", "tensorboard"])
def test_an_absent_package_is_named(run, tmp_path, monkeypatch, to):
    monkeypatch.setitem(sys.modules, to, None)
    with pytest.raises(CommandError, match=r"gpsr-workbench\[tracking\]"):
        export(run, to, tmp_path / "logs")
    assert not (tmp_path / "logs").exists()


def test_a_run_of_another_world_or_without_a_result_is_refused(run, other_world, tmp_path):
    with pytest.raises(CommandError, match=str(run.pk)):
        call_command(
            "export_run", other_world.name, str(run.pk), "--to", "tensorboard", "--output", "x"
        )
    TrainingRun.objects.filter(pk=run.pk).update(status="failed")
    with pytest.raises(CommandError, match=str(run.pk)):
        export(run, "tensorboard", tmp_path / "logs")
