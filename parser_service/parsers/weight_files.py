"""Published weights that are no transformers: GloVe's text file, ELMo's options and HDF5 file.

And whether all that a configuration needs is there, answered without loading torch.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from parser_service.parsers.encoder_places import encoders_folder, find_encoder, inside

OPTIONS_ENDING = "options.json"
WEIGHTS_ENDING = "weights.hdf5"
ELMO_SOURCE = (
    "elmo_2x4096_512_2048cnn_2xhighway_options.json and "
    "elmo_2x4096_512_2048cnn_2xhighway_weights.hdf5 as AllenNLP published them"
)


@dataclass(frozen=True, slots=True)
class ElmoFiles:
    """The two files of an ELMo."""

    options: Path
    weights: Path


def find_glove(name: str, encoders: Path | None = None) -> Path:
    """GloVe's text file ``name``, here or in the folder ``encoders``, plain or gzipped.

    Raises ValueError, a sentence that says what to put where.
    """
    for folder in _folders(encoders):
        for path in (folder / name, folder / f"{name}.gz"):
            if path.is_file():
                return path
    raise ValueError(
        f"There are no GloVe vectors: {name} is no file{inside(encoders)}, nor is {name}.gz. Put "
        f"glove.6B.100d.txt out of glove.6B.zip (nlp.stanford.edu/projects/glove) at "
        f"{(encoders or Path('ENCODERS')) / name}, as it is or gzipped."
    )


def find_elmo(name: str, encoders: Path | None = None) -> ElmoFiles:
    """The files of the ELMo in the folder ``name``, here or inside ``encoders``.

    Raises ValueError, a sentence that says what to put where.
    """
    for folder in _folders(encoders):
        options = sorted((folder / name).glob(f"*{OPTIONS_ENDING}"))
        weights = sorted((folder / name).glob(f"*{WEIGHTS_ENDING}"))
        if len(options) == len(weights) == 1:
            return ElmoFiles(options[0], weights[0])
    raise ValueError(
        f"There is no ELMo: {name} is no folder{inside(encoders)} with one file *{OPTIONS_ENDING} "
        f"and one file *{WEIGHTS_ENDING}. Put {ELMO_SOURCE} into "
        f"{(encoders or Path('ENCODERS')) / name}."
    )


def missing_weights(config: Any, encoders: Path | None = None) -> str | None:
    """What a parser with this configuration lacks before it can be trained, and where to put it.

    None where nothing is missing. ``encoders`` is the installation's folder of encoders unless
    given. The fields ``glove``, ``elmo`` and ``encoder`` name weights; an empty name needs none.
    """
    encoders = encoders or encoders_folder()
    problems = []
    for field, find in (("glove", find_glove), ("elmo", find_elmo), ("encoder", find_encoder)):
        if name := getattr(config, field, ""):
            try:
                find(name, encoders)
            except ValueError as problem:
                problems.append(str(problem))
            except OSError as problem:  # a name longer than the system allows, say
                problems.append(f"{field} cannot be looked for: {problem.strerror or problem}.")
    return " ".join(problems) or None


def refuse_missing_weights(config: Any) -> None:
    """Raises ValueError, the sentence of ``missing_weights``, where it has one."""
    if problem := missing_weights(config):
        raise ValueError(problem)


def _folders(encoders: Path | None) -> list[Path]:
    return [Path(), encoders] if encoders else [Path()]
