"""The hyperparameters of the row with ELMo, and where the files of an ELMo are. Pages read them, so torch is not
imported."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from annotations.language.texts import Refusal, require_package
from parser_service.parsers.hyperparameters.fields import hyperparameter, refuse_empty
from parser_service.parsers.hyperparameters.vectors import GloveConfig
from parser_service.parsers.pretrained_files import folders_of_names, inside

OPTIONS_ENDING = "options.json"
WEIGHTS_ENDING = "weights.hdf5"
SOURCE = (
    "elmo_2x4096_512_2048cnn_2xhighway_options.json and "
    "elmo_2x4096_512_2048cnn_2xhighway_weights.hdf5 as AllenNLP published them"
)


@dataclass(frozen=True, slots=True)
class ElmoFiles:
    """The two files of an ELMo."""

    options: Path
    weights: Path


def find_elmo(name: str, encoders: Path | None = None, anywhere: bool = True) -> ElmoFiles:
    """Return the files of the ELMo in the folder ``name``: inside ``encoders`` or, ``anywhere``, under
    any other path.

    Raises Refusal, a sentence that says what to put where, or to install.
    """
    require_package("h5py", "elmo")
    for folder in folders_of_names(encoders, anywhere):
        options = sorted((folder / name).glob(f"*{OPTIONS_ENDING}"))
        weights = sorted((folder / name).glob(f"*{WEIGHTS_ENDING}"))
        if len(options) == len(weights) == 1:
            return ElmoFiles(options[0], weights[0])
    raise Refusal(
        f"There is no ELMo: {name} is no folder{inside(encoders)} with one file *{OPTIONS_ENDING} "
        f"and one file *{WEIGHTS_ENDING}. Put {SOURCE} into "
        f"{(encoders or Path('ENCODERS')) / name}.",
        "pretrained_weights_missing",
    )


@dataclass(frozen=True)
class GloveElmoConfig(GloveConfig):
    """GloVe, and ELMo's layers mixed by learned weights."""

    elmo: str = hyperparameter(
        "elmo",
        "Folder in GPSR_ENCODERS_DIR with ELMo's options JSON and HDF5 weights.",
        finds=find_elmo,
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        refuse_empty(self, "elmo")
