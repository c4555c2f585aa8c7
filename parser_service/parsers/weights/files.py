"""Published weights of other kinds than transformers: GloVe's text file, ELMo's options and HDF5 file.

Also tells, without loading torch, whether everything that a configuration needs is there, which may be a
server too.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from parser_service.parsers.llm.places import ADDRESS, problem_of, server
from parser_service.parsers.weights.encoder_places import (
    encoders_folder,
    find_encoder,
    inside,
    refuse_path,
)

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


def find_glove(name: str, encoders: Path | None = None, anywhere: bool = True) -> Path:
    """Return GloVe's text file ``name``, plain or gzipped: in the folder ``encoders`` or, ``anywhere``,
    under any other path.

    Raises ValueError, a sentence that says what to put where.
    """
    for folder in _folders(encoders, anywhere):
        for path in (folder / name, folder / f"{name}.gz"):
            if path.is_file():
                return path
    raise ValueError(
        f"There are no GloVe vectors: {name} is no file{inside(encoders)}, nor is {name}.gz. Put "
        f"glove.6B.100d.txt out of glove.6B.zip (nlp.stanford.edu/projects/glove) at "
        f"{(encoders or Path('ENCODERS')) / name}, as it is or gzipped."
    )


def find_elmo(name: str, encoders: Path | None = None, anywhere: bool = True) -> ElmoFiles:
    """Return the files of the ELMo in the folder ``name``: inside ``encoders`` or, ``anywhere``, under
    any other path.

    Raises ValueError, a sentence that says what to put where.
    """
    for folder in _folders(encoders, anywhere):
        options = sorted((folder / name).glob(f"*{OPTIONS_ENDING}"))
        weights = sorted((folder / name).glob(f"*{WEIGHTS_ENDING}"))
        if len(options) == len(weights) == 1:
            return ElmoFiles(options[0], weights[0])
    raise ValueError(
        f"There is no ELMo: {name} is no folder{inside(encoders)} with one file *{OPTIONS_ENDING} "
        f"and one file *{WEIGHTS_ENDING}. Put {ELMO_SOURCE} into "
        f"{(encoders or Path('ENCODERS')) / name}."
    )


def missing_weights(config: Any, encoders: Path | None = None, anywhere: bool = True) -> str | None:
    """Return what a parser with this configuration lacks before it can be trained, and where to put it.

    None where nothing is missing. ``encoders`` is the installation's folder of encoders unless
    given; ``anywhere`` is False for requests from pages and the REST API, which look there and in
    the listed packages alone. The fields ``glove``, ``elmo`` and ``encoder`` name weights; an empty
    name needs none. A configuration with ``needs_server`` needs one that may be asked.
    """
    return " ".join(each.sentence for each in find_gaps(config, encoders, anywhere)) or None


@dataclass(frozen=True, slots=True)
class Gap:
    """Weights, or a server, that are not there: their name, and a sentence that says what to put where."""

    name: str
    sentence: str


def find_gaps(config: Any, encoders: Path | None = None, anywhere: bool = True) -> list[Gap]:
    """Return the weights that ``missing_weights`` tells of, one by one."""
    encoders = encoders or encoders_folder()
    gaps = []
    if getattr(config, "needs_server", False) and (sentence := problem_of(server())):
        gaps.append(Gap(ADDRESS, sentence))
    for field, find in (("glove", find_glove), ("elmo", find_elmo), ("encoder", find_encoder)):
        if name := getattr(config, field, ""):
            try:
                if not anywhere:
                    refuse_path(field, name)
                find(name, encoders, anywhere)
            except ValueError as error:
                gaps.append(Gap(name, str(error)))
            except OSError as error:  # a name longer than the system allows, say
                sentence = f"{field} cannot be looked for: {error.strerror or error}."
                gaps.append(Gap(name, sentence))
    return gaps


def refuse_missing_weights(config: Any, anywhere: bool = True) -> None:
    """Raise ValueError, the sentence of ``missing_weights``, where it has one."""
    if sentence := missing_weights(config, anywhere=anywhere):
        raise ValueError(sentence)


def _folders(encoders: Path | None, anywhere: bool) -> list[Path]:
    """Return the folders that names start from; the installation's comes first."""
    return [*([encoders] if encoders else []), *([Path()] if anywhere else [])]
