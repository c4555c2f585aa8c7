"""The data of a run's charts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from parser_service.models import EpochMetric, TrainingRun


def loss_curves(epochs: Sequence[EpochMetric]) -> dict[str, Any]:
    """Return training loss and, where it was measured, validation loss, in the unit of the registry."""
    series = [{"name": "training", "values": [each.train_loss for each in epochs]}]
    if any(each.validation_loss is not None for each in epochs):
        series.append({"name": "validation", "values": [each.validation_loss for each in epochs]})
    return _lines(epochs, series, {"label": "loss"})


def accuracy_curve(epochs: Sequence[EpochMetric]) -> dict[str, Any]:
    """Return exact match on the validation part in percent; None where it was not measured."""
    values = [
        None if each.validation_accuracy is None else 100 * each.validation_accuracy
        for each in epochs
    ]
    y = {"label": "exact match", "max": 100, "unit": "%"}
    return _lines(epochs, [{"name": "validation", "values": values}], y)


def seconds_curve(epochs: Sequence[EpochMetric]) -> dict[str, Any]:
    """Return how many seconds each epoch took."""
    values = [round(each.seconds, 2) for each in epochs]
    return _lines(epochs, [{"name": "training", "values": values}], {"label": "time", "unit": "s"})


def will_have_curves(run: TrainingRun) -> bool:
    """Tell whether the parser of ``run`` trains in epochs."""
    return bool({"epochs", "steps"} & set(run.config))


def _lines(epochs: Sequence[EpochMetric], series: list[Any], y: dict[str, Any]) -> dict[str, Any]:
    x = {"label": "epoch", "values": [each.epoch for each in epochs]}
    return {"kind": "lines", "x": x, "series": series, "y": y}


CURVES = {"loss": loss_curves, "accuracy": accuracy_curve, "seconds": seconds_curve}
