"""The state of a ranker's training on disk."""

from __future__ import annotations

from pathlib import Path

import torch
from safetensors.torch import save_file

from parser_service.neural.ranker.training import RankerTraining
from parser_service.neural.training import TENSORS, TRAINING, load_optimizer, optimizer_tensors
from parser_service.neural.weights import load_tensors
from parser_service.parsers.storage import read_json, write_json

FILES = (TRAINING, TENSORS)


def save_training(folder: Path, training: RankerTraining) -> None:
    """Write what ``load_training`` reads: live and averaged weights and the optimizer's state.

    For use while the average is in force.
    """
    tensors = optimizer_tensors(training.optimizer, training.model.trained())
    for name, _ in training.model.trained():
        tensors[f"live.{name}"] = training.average.live[name]
        tensors[f"average.{name}"] = training.average.values[name]
    save_file({name: value.contiguous() for name, value in tensors.items()}, folder / TENSORS)
    write_json(folder / TRAINING, {"epoch": training.epoch})


@torch.no_grad()
def load_training(folder: Path, training: RankerTraining) -> int:
    """Put ``training`` into the state that ``save_training`` wrote; return its epoch. Raises
    ValueError."""
    tensors = load_tensors(folder / TENSORS)
    for name, weight in training.model.trained():
        weight.copy_(tensors[f"live.{name}"])
        training.average.values[name].copy_(tensors[f"average.{name}"])
    load_optimizer(training.optimizer, training.model.trained(), tensors)
    training.epoch = read_json(folder / TRAINING)["epoch"]
    return training.epoch
