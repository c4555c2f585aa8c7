"""The state of a fine-tuning on disk."""

from __future__ import annotations

from pathlib import Path

from safetensors.torch import save_file

from parser_service.neural.t5.training import Training
from parser_service.neural.training import TENSORS, TRAINING, load_optimizer, optimizer_tensors
from parser_service.neural.weights import WEIGHTS, load_tensors
from parser_service.parsers.storage import read_json, write_json

FILES = (TRAINING, TENSORS)


def save_training(folder: Path, training: Training) -> None:
    """Write all that ``load_training`` needs beside the network's weights."""
    weights = training.network.model.named_parameters()
    tensors = optimizer_tensors(training.optimizer, weights)
    save_file({name: value.contiguous() for name, value in tensors.items()}, folder / TENSORS)
    about = {"step": training.step, "seconds": training.seconds, "losses": training.losses}
    write_json(folder / TRAINING, about)


def load_training(folder: Path, training: Training) -> int:
    """Put ``training`` into the state that ``save_training`` wrote, its network included; return its
    step. Raises ValueError, a sentence."""
    training.network.load(load_tensors(folder / WEIGHTS), folder / WEIGHTS)
    weights = list(training.network.model.named_parameters())
    load_optimizer(training.optimizer, weights, load_tensors(folder / TENSORS))
    about = read_json(folder / TRAINING)
    training.step, training.seconds = about["step"], about["seconds"]
    training.losses = about["losses"]
    return training.step
