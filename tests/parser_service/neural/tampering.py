"""What somebody may do to the weights of a saved parser."""

from pathlib import Path

import torch

from parser_service.neural.weights import WEIGHTS
from parser_service.parsers.storage import CONFIG, file_hash, read_json, write_json


def alter_weights(folder: Path) -> None:
    """Turns over one bit of the last weight."""
    content = bytearray((folder / WEIGHTS).read_bytes())
    content[-1] ^= 1
    (folder / WEIGHTS).write_bytes(content)


def pickle_weights(folder: Path, weights: dict[str, torch.Tensor]) -> None:
    """Puts a pickle in the place of the weights, under their name and with its own hash."""
    torch.save(weights, folder / WEIGHTS)
    about = read_json(folder / CONFIG)
    about["sha256"][WEIGHTS] = file_hash(folder / WEIGHTS)
    write_json(folder / CONFIG, about)
