"""ELMo's HDF5 file: its datasets as tensors of layers, in the shapes that the options describe."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import h5py
import torch
from torch import Tensor

from parser_service.neural.device import processor
from parser_service.neural.word_vectors.elmo_characters import CHARACTERS
from parser_service.neural.word_vectors.elmo_layers import (
    Affine,
    CharacterCnn,
    Convolution,
    Highway,
    ProjectedLstm,
)
from parser_service.neural.word_vectors.elmo_options import ElmoOptions

FORWARD, BACKWARD = 0, 1


class ElmoWeights:
    """The layers in one file."""

    def __init__(self, path: Path, file: h5py.File, options: ElmoOptions):
        self._path, self._file, self._options = path, file, options

    def character_cnn(self) -> CharacterCnn:
        """Read the layer without context. Raises ValueError, as all methods, where the file lacks it."""
        options = self._options
        filters = sum(number for _, number in options.filters)
        return CharacterCnn(
            table=self._tensor("char_embed", CHARACTERS, options.character_size),
            convolutions=tuple(map(self._convolution, range(len(options.filters)))),
            highways=tuple(self._highway(index, filters) for index in range(options.highways)),
            projection=self._affine("CNN_proj", "proj", filters, options.projection),
        )

    def lstm(self, direction: int, layer: int) -> ProjectedLstm:
        """Read one layer of one direction."""
        options, size = self._options, self._options.projection
        place = f"RNN_{direction}/RNN/MultiRNNCell/Cell{layer}/LSTMCell"
        gates = Affine(
            self._tensor(f"{place}/W_0", 2 * size, 4 * options.cells),
            self._tensor(f"{place}/B", 4 * options.cells),
        )
        projection = self._tensor(f"{place}/W_P_0", options.cells, size)
        return ProjectedLstm(gates, projection, options.cell_clip, options.projection_clip)

    def _convolution(self, index: int) -> Convolution:
        width, number = self._options.filters[index]
        weight = self._tensor(f"CNN/W_cnn_{index}", 1, width, self._options.character_size, number)
        bias = self._tensor(f"CNN/b_cnn_{index}", number)
        activation = torch.relu if self._options.activation == "relu" else torch.tanh
        return Convolution(weight[0].permute(2, 1, 0).contiguous(), bias, activation)

    def _highway(self, index: int, size: int) -> Highway:
        group = f"CNN_high_{index}"
        return Highway(
            gate=self._affine(group, "carry", size, size),
            transform=self._affine(group, "transform", size, size),
        )

    def _affine(self, group: str, name: str, entry: int, exit_: int) -> Affine:
        weight = self._tensor(f"{group}/W_{name}", entry, exit_)
        return Affine(weight, self._tensor(f"{group}/b_{name}", exit_))

    def _tensor(self, name: str, *shape: int) -> Tensor:
        dataset = self._file.get(name)
        present = dataset.shape if isinstance(dataset, h5py.Dataset) else None
        if present != shape:
            has = f"has {list(present)}" if present else "is not there"
            raise ValueError(
                f"{self._path}: {name} should have shape {list(shape)} but {has}; put the weights "
                "there that were published with the options.json beside them."
            )
        return torch.from_numpy(dataset[...].astype("float32")).to(processor())


@contextmanager
def open_weights(path: Path, options: ElmoOptions) -> Iterator[ElmoWeights]:
    """Open the layers in ``path``. Raises ValueError, a sentence, where it is not an HDF5 file."""
    try:
        file = h5py.File(path, "r")
    except OSError:
        raise ValueError(
            f"{path} is not an HDF5 file; put ELMo's published weights there again."
        ) from None
    with file:
        yield ElmoWeights(path, file, options)
