"""The state of a training on disk, as safetensors and JSON."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

import torch
from torch import Tensor, nn

from parser_service.parsers.interface import Observer

TRAINING = "training.json"
TENSORS = "training.safetensors"

NamedWeights = Iterable[tuple[str, nn.Parameter]]


def optimizer_tensors(optimizer: torch.optim.Optimizer, weights: NamedWeights) -> dict[str, Tensor]:
    """Return what ``optimizer`` remembers of each of ``weights``, by names that begin with "adam."."""
    return {
        f"adam.{name}.{key}": value
        for name, weight in weights
        for key, value in optimizer.state[weight].items()
    }


def load_optimizer(
    optimizer: torch.optim.Optimizer, weights: NamedWeights, tensors: Mapping[str, Tensor]
) -> None:
    """Put ``optimizer`` into the state that ``optimizer_tensors`` returned."""
    names = {weight: name for name, weight in weights}
    groups = optimizer.state_dict()["param_groups"]  # they number the weights in this order
    in_order = [weight for group in optimizer.param_groups for weight in group["params"]]
    state = {
        number: tensors_under(f"adam.{names[weight]}.", tensors)
        for number, weight in enumerate(in_order)
    }
    optimizer.load_state_dict({"state": state, "param_groups": groups})


def tensors_under(prefix: str, tensors: Mapping[str, Tensor]) -> dict[str, Tensor]:
    """Return the tensors whose names begin with ``prefix``, by the rest of their names."""
    return {name.removeprefix(prefix): t for name, t in tensors.items() if name.startswith(prefix)}


def resume(
    observe: Observer,
    check: Callable[[Path], object],
    load: Callable[[Path], int],
    unit: str = "epoch",
) -> None:
    """Resume from the last checkpoint, or start from the beginning, to the same end, where there is
    none or it cannot be read.

    Args:
        observe: knows the checkpoint and takes a line for the log.
        check: raises ValueError, a sentence, where a folder is no checkpoint of this training.
        load: puts the training into the state in a folder; returns the number of the ``unit`` it was saved
            after.
    """
    folder = observe.last_checkpoint()
    if folder is None:
        return
    try:
        check(folder)
    except ValueError as error:
        observe.log(
            f"The last checkpoint is unreadable; training starts from the beginning. {error}"
        )
        return
    observe.log(f"Resuming after {unit} {load(folder)}.")
