"""Weights and the state of a training, on disk as safetensors and JSON."""

from __future__ import annotations

from pathlib import Path

from safetensors import SafetensorError
from safetensors.torch import load_file, save_file
from torch import Tensor, nn

from parser_service.neural.training import Result, Training
from parser_service.parsers.storage import read_json, write_json

WEIGHTS = "model.safetensors"
TRAINING = "training.json"
TENSORS = "training.safetensors"


def save_weights(path: Path, model: nn.Module) -> None:
    """Writes the weights of ``model``."""
    save_file({name: value.contiguous() for name, value in model.state_dict().items()}, path)


def load_weights(path: Path, model: nn.Module) -> None:
    """Gives ``model`` the weights in ``path``. Raises ValueError, a sentence, where the file is no
    safetensors or holds the weights of another shape."""
    try:
        model.load_state_dict(load_tensors(path))
    except RuntimeError:  # torch's way to say that names or shapes differ
        raise ValueError(f"{path} holds the weights of another model; train it again.") from None


def load_tensors(path: Path) -> dict[str, Tensor]:
    """The tensors in a safetensors file. Raises ValueError, a sentence, where it is none: no
    other format is read, so that a file can never run code."""
    try:
        return load_file(path)
    except (SafetensorError, OSError):
        raise ValueError(
            f"{path} is not a safetensors file, and no other kind is read; train it again."
        ) from None


def save_training(folder: Path, training: Training) -> None:
    """Writes all that ``load_training`` needs beside the model's weights."""
    tensors = {"generator": training.generator.get_state()}
    for name, value in training.best_weights.items():
        tensors[f"best.{name}"] = value
    for name, parameter in training.model.named_parameters():
        for key, value in training.optimizer.state[parameter].items():
            tensors[f"adam.{name}.{key}"] = value
    save_file(tensors, folder / TENSORS)
    best = training.best and {"accuracy": training.best.accuracy, "loss": training.best.loss}
    about = {"epoch": training.epoch, "best_epoch": training.best_epoch, "best": best}
    write_json(folder / TRAINING, about)


def load_training(folder: Path, training: Training) -> None:
    """Puts ``training`` into the state that ``save_training`` wrote, its model included."""
    tensors = load_tensors(folder / TENSORS)
    load_weights(folder / WEIGHTS, training.model)
    names = [name for name, _ in training.model.named_parameters()]
    adam = {at: _under(f"adam.{name}.", tensors) for at, name in enumerate(names)}
    groups = training.optimizer.state_dict()["param_groups"]
    training.optimizer.load_state_dict({"state": adam, "param_groups": groups})
    training.best_weights = _under("best.", tensors)
    training.generator.set_state(tensors["generator"])
    about = read_json(folder / TRAINING)
    training.epoch, training.best_epoch = about["epoch"], about["best_epoch"]
    training.best = Result(**about["best"]) if about["best"] else None


def _under(prefix: str, tensors: dict[str, Tensor]) -> dict[str, Tensor]:
    return {name.removeprefix(prefix): t for name, t in tensors.items() if name.startswith(prefix)}
