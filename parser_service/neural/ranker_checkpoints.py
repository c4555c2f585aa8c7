"""The state of a ranker's training on disk, as safetensors and JSON."""

from __future__ import annotations

from pathlib import Path

import torch
from safetensors.torch import save_file

from parser_service.neural.checkpoints import TENSORS, TRAINING, load_tensors
from parser_service.neural.ranker_training import RankerTraining
from parser_service.parsers.storage import read_json, write_json

FILES = (TRAINING, TENSORS)


def save_training(folder: Path, training: RankerTraining) -> None:
    """Writes what ``load_training`` reads: live and averaged weights and the optimiser's state.

    For use while the average is in force.
    """
    tensors = {}
    for name, weight in training.model.trained():
        tensors[f"live.{name}"] = training.average.live[name]
        tensors[f"average.{name}"] = training.average.values[name]
        for key, value in training.optimizer.state[weight].items():
            tensors[f"adam.{name}.{key}"] = value
    save_file({name: value.contiguous() for name, value in tensors.items()}, folder / TENSORS)
    write_json(folder / TRAINING, {"epoch": training.epoch})


@torch.no_grad()
def load_training(folder: Path, training: RankerTraining) -> None:
    """Puts ``training`` into the state that ``save_training`` wrote. Raises ValueError."""
    tensors = load_tensors(folder / TENSORS)
    for name, weight in training.model.trained():
        weight.copy_(tensors[f"live.{name}"])
        training.average.values[name].copy_(tensors[f"average.{name}"])
        prefix = f"adam.{name}."
        training.optimizer.state[weight] = {
            key.removeprefix(prefix): value.to(weight.device)
            for key, value in tensors.items()
            if key.startswith(prefix)
        }
    training.epoch = read_json(folder / TRAINING)["epoch"]
