"""The state of a sequence-to-sequence training on disk."""

from __future__ import annotations

from pathlib import Path

from safetensors.torch import save_file

from parser_service.neural.seq2seq.training import Result, Training
from parser_service.neural.training import (
    TENSORS,
    TRAINING,
    load_optimizer,
    optimizer_tensors,
    tensors_under,
)
from parser_service.neural.weights import WEIGHTS, load_tensors, load_weights
from parser_service.parsers.storage import read_json, write_json

FILES = (TRAINING, TENSORS)


def save_training(folder: Path, training: Training) -> None:
    """Write all that ``load_training`` needs beside the model's weights."""
    tensors = {"generator": training.generator.get_state()}
    for name, value in training.best_weights.items():
        tensors[f"best.{name}"] = value
    tensors |= optimizer_tensors(training.optimizer, training.model.named_parameters())
    save_file(tensors, folder / TENSORS)
    best = training.best and {"accuracy": training.best.accuracy, "loss": training.best.loss}
    about = {"epoch": training.epoch, "best_epoch": training.best_epoch, "best": best}
    write_json(folder / TRAINING, about)


def load_training(folder: Path, training: Training) -> int:
    """Put ``training`` into the state that ``save_training`` wrote, its model included; return its
    epoch."""
    tensors = load_tensors(folder / TENSORS)
    load_weights(folder / WEIGHTS, training.model)
    load_optimizer(training.optimizer, training.model.named_parameters(), tensors)
    training.best_weights = tensors_under("best.", tensors)
    training.generator.set_state(tensors["generator"])
    about = read_json(folder / TRAINING)
    training.epoch, training.best_epoch = about["epoch"], about["best_epoch"]
    training.best = Result(**about["best"]) if about["best"] else None
    return training.epoch
