"""The files of an ELMo: its sizes from the options JSON, and its layers from the HDF5 weights."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import h5py
import torch
from torch import Tensor

from annotations.language.texts import Refusal
from parser_service.neural.device import processor
from parser_service.neural.elmo.layers import (
    CHARACTERS,
    Affine,
    CharacterCnn,
    Convolution,
    Highway,
    ProjectedLstm,
)
from parser_service.parsers.storage import read_json

ACTIVATIONS = ("relu", "tanh")
FORWARD, BACKWARD = 0, 1


@dataclass(frozen=True, slots=True)
class ElmoOptions:
    """What the options file says (Peters et al. 2018, section 3.4, gives the published sizes)."""

    longest_word: int  # characters, markers included
    character_size: int
    filters: tuple[tuple[int, int], ...]  # width in characters, how many
    activation: str
    highways: int
    projection: int  # width of a word in one direction
    cells: int
    layers: int  # of LSTM
    cell_clip: float
    projection_clip: float
    has_skips: bool  # each LSTM layer but the first adds its input to its output

    @property
    def width(self) -> int:
        """Numbers in the vector of a word: both directions."""
        return 2 * self.projection


def read_elmo_options(path: Path) -> ElmoOptions:
    """Return the options in a JSON file. Raises Refusal where one is absent or unknown."""
    try:
        values = read_json(path)
        characters, lstm = values["char_cnn"], values["lstm"]
        options = ElmoOptions(
            longest_word=int(characters["max_characters_per_token"]),
            character_size=int(characters["embedding"]["dim"]),
            filters=tuple((int(width), int(number)) for width, number in characters["filters"]),
            activation=str(characters["activation"]),
            highways=int(characters["n_highway"]),
            projection=int(lstm["projection_dim"]),
            cells=int(lstm["dim"]),
            layers=int(lstm["n_layers"]),
            cell_clip=float(lstm["cell_clip"]),
            projection_clip=float(lstm["proj_clip"]),
            has_skips=bool(lstm["use_skip_connections"]),
        )
        rows = int(characters["n_characters"])
    except (KeyError, TypeError, ValueError) as error:
        raise Refusal(
            f"{path} does not describe an ELMo with a character CNN ({error!r}); put "
            "the options.json there that was published with the weights.",
            "pretrained_weights_unreadable",
        ) from None
    if options.activation not in ACTIVATIONS or rows not in (CHARACTERS, CHARACTERS + 1):
        raise Refusal(
            f"{path} describes an ELMo with activation {options.activation!r} and {rows} "
            f"characters; only {' and '.join(ACTIVATIONS)} and {CHARACTERS + 1} are read.",
            "pretrained_weights_unreadable",
        )
    return options


class ElmoWeights:
    """The layers in one file."""

    def __init__(self, path: Path, file: h5py.File, options: ElmoOptions):
        self._path, self._file, self._options = path, file, options

    def character_cnn(self) -> CharacterCnn:
        """Read the layer without context. Raises Refusal, as all methods, where the file lacks it."""
        options = self._options
        filters = sum(number for _, number in options.filters)
        return CharacterCnn(
            table=self._tensor("char_embed", CHARACTERS, options.character_size),
            convolutions=tuple(map(self._convolution, range(len(options.filters)))),
            highways=tuple(
                Highway(
                    gate=self._affine(f"CNN_high_{index}", "carry", filters, filters),
                    transform=self._affine(f"CNN_high_{index}", "transform", filters, filters),
                )
                for index in range(options.highways)
            ),
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

    def _affine(self, group: str, name: str, entry: int, exit_: int) -> Affine:
        weight = self._tensor(f"{group}/W_{name}", entry, exit_)
        return Affine(weight, self._tensor(f"{group}/b_{name}", exit_))

    def _tensor(self, name: str, *shape: int) -> Tensor:
        dataset = self._file.get(name)
        present = dataset.shape if isinstance(dataset, h5py.Dataset) else None
        if present != shape:
            has = f"has {list(present)}" if present else "is not there"
            raise Refusal(
                f"{self._path}: {name} should have shape {list(shape)} but {has}; put the weights "
                "there that were published with the options.json beside them.",
                "pretrained_weights_unreadable",
            )
        return torch.from_numpy(dataset[...].astype("float32")).to(processor())


@contextmanager
def open_weights(path: Path, options: ElmoOptions) -> Iterator[ElmoWeights]:
    """Open the layers in ``path``. Raises Refusal where it is not an HDF5 file."""
    try:
        file = h5py.File(path, "r")
    except OSError:
        raise Refusal(
            f"{path} is not an HDF5 file; put ELMo's published weights there again.",
            "pretrained_weights_unreadable",
        ) from None
    with file:
        yield ElmoWeights(path, file, options)
