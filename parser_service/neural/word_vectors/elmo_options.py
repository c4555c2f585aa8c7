"""The sizes of an ELMo, from the options JSON that is published beside its weights."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from parser_service.neural.word_vectors.elmo_characters import CHARACTERS
from parser_service.parsers.storage import read_json

ACTIVATIONS = ("relu", "tanh")


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
    """Return the options in a JSON file. Raises ValueError, a sentence, where one is absent or unknown."""
    try:
        values = read_json(path)
        characters, lstm = values["char_cnn"], values["lstm"]
        options = _options(characters, lstm)
        rows = int(characters["n_characters"])
    except (KeyError, TypeError, ValueError) as error:
        raise ValueError(
            f"{path} does not describe an ELMo with a character CNN ({error!r}); put "
            "the options.json there that was published with the weights."
        ) from None
    if options.activation not in ACTIVATIONS or rows not in (CHARACTERS, CHARACTERS + 1):
        raise ValueError(
            f"{path} describes an ELMo with activation {options.activation!r} and {rows} "
            f"characters; only {' and '.join(ACTIVATIONS)} and {CHARACTERS + 1} are read."
        )
    return options


def _options(characters: Mapping[str, Any], lstm: Mapping[str, Any]) -> ElmoOptions:
    return ElmoOptions(
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
