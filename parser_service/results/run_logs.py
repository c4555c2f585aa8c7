"""Verb: write runs with their curves and scores as MLflow and TensorBoard keep them, where these are installed."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Sequence
from datetime import datetime
from enum import StrEnum
from pathlib import Path
from typing import Any, NamedTuple

from annotations.language.texts import Refusal, require_package
from parser_service.models import TrainingRun
from parser_service.results.run_figures import report_run

_MEASURES = ("accuracy", "equivalent", "same_plan", "well_formed")
_OF_EPOCHS = {
    "train/loss": "train_loss",
    "validation/loss": "validation_loss",
    "validation/accuracy": "validation_accuracy",
}
_LONGEST_PARAM = 6_000  # characters, of MLflow
_MOST_METRICS = 1_000  # of one call of MLflow
RUN_TAG = "gpsr.run"


class LogFormat(StrEnum):
    MLFLOW = "mlflow"
    TENSORBOARD = "tensorboard"


class Figure(NamedTuple):
    """A number of a run at an epoch; scores are at the last one."""

    name: str
    value: float
    epoch: int


def export_runs(runs: Sequence[TrainingRun], as_: str, target: str) -> list[str]:
    """Write ``runs``; return where each is.

    Args:
        as_: a ``LogFormat``.
        target: a folder; of MLflow also the address of a tracking server or of its database.

    Raises:
        Refusal: the package is absent, or a run is there already.
        OSError: the folder cannot be written.
    """
    require_package("mlflow" if as_ == LogFormat.MLFLOW else "tensorboard", "tracking")
    return (_to_mlflow if as_ == LogFormat.MLFLOW else _to_tensorboard)(runs, target)


def figures_of(run: TrainingRun) -> Iterator[Figure]:
    """Yield the curves of a run by epoch, then its scores, fractions of 1."""
    last = 0
    for each in run.epochs.all():
        last = each.epoch
        for name, column in _OF_EPOCHS.items():
            if (value := getattr(each, column)) is not None:
                yield Figure(name, value, last)
    for score in report_run(run)["evaluations"]:
        for measure in _MEASURES:
            if (value := score[measure]) is not None:
                yield Figure(f"{score['part']}/{score['test_source']}/{measure}", value, last)


def parameters_of(run: TrainingRun) -> dict[str, Any]:
    """Return what the figures of a run depend on, the configuration's with ``config.`` before their names."""
    report = report_run(run)
    names = ("parser", "version", "protocol", "split", "criterion", "train_sources", "train_share")
    more = ("train_pairs", "seed", "parameters", "seconds_trained")
    config = {f"config.{name}": value for name, value in run.config.items()}
    return {name: report[name] for name in (*names, *more)} | config


def _name(run: TrainingRun) -> str:
    return f"run-{run.pk}-{run.parser}"


def _refuse_again(run: TrainingRun, target: str) -> Refusal:
    return Refusal(
        f"{run} is at {target} already. Remove it there, or choose another folder.",
        "exported_already",
    )


def _to_tensorboard(runs: Sequence[TrainingRun], target: str) -> list[str]:
    """Write a folder of events for each run."""
    from torch.utils.tensorboard import SummaryWriter

    folders = {run.pk: Path(target) / _name(run) for run in runs}
    for run in runs:
        if folders[run.pk].exists():
            raise _refuse_again(run, target)
    for run in runs:
        with SummaryWriter(str(folders[run.pk])) as writer:
            listed = json.dumps(parameters_of(run), indent=2, ensure_ascii=False)
            writer.add_text("parameters", f"```json\n{listed}\n```")
            for figure in figures_of(run):
                writer.add_scalar(*figure)
    return [str(folder) for folder in folders.values()]


def _to_mlflow(runs: Sequence[TrainingRun], target: str) -> list[str]:
    """Write a run of MLflow for each run, in an experiment that is called as the world."""
    from mlflow import MlflowClient
    from mlflow.entities import Metric, Param, RunTag

    address = target
    if "://" not in target:
        os.environ.setdefault("MLFLOW_ALLOW_FILE_STORE", "true")  # MLflow prefers a database
        address = Path(target).resolve().as_uri()
    client = MlflowClient(tracking_uri=address)
    places: list[str] = []
    for run in runs:
        experiment = client.get_experiment_by_name(run.world.name)
        key = experiment.experiment_id if experiment else client.create_experiment(run.world.name)
        if client.search_runs([key], f"tags.`{RUN_TAG}` = '{run.pk}'"):
            raise _refuse_again(run, target)
        begun, ended = _milliseconds(run.started_at), _milliseconds(run.finished_at)
        made = client.create_run(key, start_time=begun, run_name=_name(run)).info
        params = [
            Param(name, str(value)[:_LONGEST_PARAM]) for name, value in parameters_of(run).items()
        ]
        tags = [RunTag(RUN_TAG, str(run.pk)), RunTag("gpsr.split_hash", run.split.content_hash)]
        client.log_batch(made.run_id, params=params, tags=tags)
        metrics = [Metric(name, value, ended or 0, epoch) for name, value, epoch in figures_of(run)]
        for n in range(0, len(metrics), _MOST_METRICS):
            client.log_batch(made.run_id, metrics=metrics[n : n + _MOST_METRICS])
        client.set_terminated(made.run_id, end_time=ended)
        places.append(f"{target}: {run.world.name}, {made.run_name}, {made.run_id}")
    return places


def _milliseconds(moment: datetime | None) -> int | None:
    return round(1_000 * moment.timestamp()) if moment else None
