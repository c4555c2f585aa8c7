"""The hyperparameters of the sequence-to-sequence parser. Pages read them, so torch is not imported."""

from __future__ import annotations

from dataclasses import dataclass

from annotations.language.texts import Refusal
from parser_service.parsers.hyperparameters.fields import hyperparameter, validate


@dataclass(frozen=True)
class Seq2SeqConfig:
    """Sizes, optimisation and decoding.

    Beam, dropout, epochs and patience are those of Walker et al. 2019; sizes, batch and learning
    rate were chosen on the validation part of its paraphrases for training in minutes on two cores.
    """

    embedding_size: int = hyperparameter(
        100, "Width of a word vector, in commands and in forms.", minimum=2, maximum=1024
    )
    hidden_size: int = hyperparameter(
        128,
        "Cells of the decoder; each direction of the encoder has half.",
        minimum=2,
        maximum=2048,
    )
    minimum_count: int = hyperparameter(
        2,
        "Words seen less often than this in training are read as unknown.",
        minimum=1,
        maximum=100,
    )
    dropout: float = hyperparameter(
        0.1, "Share of the encoder's values that is dropped in training.", minimum=0.0, maximum=0.9
    )
    learning_rate: float = hyperparameter(
        0.004, "Learning rate of Adam.", minimum=1e-6, maximum=1.0
    )
    batch_size: int = hyperparameter(32, "Pairs per step.", minimum=1, maximum=4096)
    clip: float = hyperparameter(
        5.0,
        "Largest norm of the gradient; larger ones are scaled down to it.",
        minimum=1e-3,
        maximum=1e6,
    )
    epochs: int = hyperparameter(150, "Maximum passes over the training pairs.", 1, 10_000)
    patience: int = hyperparameter(
        10, "Epochs without a better validation result before training stops.", 1, 10_000
    )
    beam_width: int = hyperparameter(
        5,
        "Forms kept while decoding: in validation, and in prediction unless more are asked for.",
        1,
        100,
    )
    # More threads than free cores wait for each other: beside other work, two are ten times slower
    # than one. Another number also rounds differently; one gives the same result on every machine.
    threads: int = hyperparameter(
        1, "Processor cores to compute on; 0: all. Another number rounds differently.", 0, 256
    )

    def __post_init__(self) -> None:
        validate(self)
        if self.hidden_size % 2:
            raise Refusal(
                f"hidden_size is {self.hidden_size}, but it has to be even: the two directions of "
                "the encoder share it.",
                "hyperparameter_out_of_range",
            )
