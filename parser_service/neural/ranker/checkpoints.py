"""The state of a ranker's training on disk."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import torch
from safetensors.torch import save_file

from parser_service.neural.ranker.training import RankerTraining
from parser_service.neural.training import TENSORS, TRAINING, load_optimizer, optimizer_tensors
from parser_service.neural.weights import load_tensors
from parser_service.parsers.storage import read_json, write_json

FILES = (TRAINING, TENSORS)
GLOSSES = "glosses"


def save_training(folder: Path, training: RankerTraining, about: dict[str, Any]) -> None:
    """Write what ``load_training`` reads: the weights that training changes, their average, the state of
    the optimizer and the vectors of the glosses. ``about`` is stored beside them.

    Pretrained weights that training leaves alone are not among them.
    """
    tensors = optimizer_tensors(training.optimizer, training.trained())
    tensors |= {f"live.{name}": weight.detach() for name, weight in training.trained()}
    tensors |= {f"average.{name}": value for name, value in training.average.values.items()}
    tensors[GLOSSES] = training.model.glosses.vectors
    save_file({name: value.contiguous() for name, value in tensors.items()}, folder / TENSORS)
    state = {**about, "step": training.step, "losses": training.losses}
    write_json(folder / TRAINING, state)


@torch.no_grad()
def load_training(folder: Path, training: RankerTraining) -> None:
    """Put ``training`` into the state that ``save_training`` wrote. Raises ValueError."""
    tensors = load_tensors(folder / TENSORS)
    for name, weight in training.trained():
        weight.copy_(tensors[f"live.{name}"])
    for name, value in training.average.values.items():
        value.copy_(tensors[f"average.{name}"])
    training.model.glosses.vectors.copy_(tensors[GLOSSES])
    load_optimizer(training.optimizer, training.trained(), tensors)
    state = read_json(folder / TRAINING)
    training.step, training.losses = state["step"], state["losses"]
