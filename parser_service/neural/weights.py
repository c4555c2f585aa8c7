"""Weights on disk: safetensors and nothing else."""

from __future__ import annotations

from http import HTTPStatus
from pathlib import Path

from safetensors import SafetensorError
from safetensors.torch import load_file, save_file
from torch import Tensor, nn

from annotations.language.texts import Refusal

WEIGHTS = "model.safetensors"


def save_weights(path: Path, model: nn.Module) -> None:
    """Write the weights of ``model``."""
    save_file({name: value.contiguous() for name, value in model.state_dict().items()}, path)


def load_weights(path: Path, model: nn.Module) -> None:
    """Load the weights in ``path`` into ``model``. Raises Refusal where the file is not
    safetensors or its weights have other names or shapes."""
    try:
        model.load_state_dict(load_tensors(path))
    except RuntimeError:  # torch raises it where names or shapes differ
        raise Refusal(
            f"{path} holds the weights of another model; train it again.",
            "saved_parser_unreadable",
            HTTPStatus.CONFLICT,
        ) from None


def load_tensors(path: Path) -> dict[str, Tensor]:
    """Read a safetensors file. Raises Refusal where it is something else: no other
    format is read, so a file can never run code."""
    try:
        return load_file(path)
    except (SafetensorError, OSError):
        raise Refusal(
            f"{path} is not a safetensors file, and no other kind is read; train it again.",
            "saved_parser_unreadable",
            HTTPStatus.CONFLICT,
        ) from None
