"""The hyperparameters of the fine-tuned encoder–decoder. Pages read them, so torch is not imported."""

from __future__ import annotations

from dataclasses import dataclass

from parser_service.parsers.hyperparameters.fields import hyperparameter, refuse_empty, validate
from parser_service.parsers.pretrained_files import find_encoder


@dataclass(frozen=True)
class EncoderDecoderConfig:
    """Weights, optimisation and decoding. The number of steps does not depend on the number of pairs."""

    encoder: str = hyperparameter(
        "google/flan-t5-small",
        "Pretrained encoder–decoder (T5, FLAN-T5, BART): its name in GPSR_ENCODERS_DIR, or a package.",
        finds=find_encoder,
    )
    decoding: str = hyperparameter(
        "typed",
        "What may be written: anything (free), one of the forms of the training pairs and, under domain, "
        "the candidates made from them (listed), or any form that the signatures allow (typed).",
        choices=("free", "listed", "typed"),
    )
    steps: int = hyperparameter(2000, "Optimisation steps.", 1, 1_000_000)
    minutes: float = hyperparameter(
        0.0, "Minutes after which training ends early; 0: never.", 0.0, 10_000.0
    )
    batch_size: int = hyperparameter(16, "Pairs per step.", minimum=1, maximum=4096)
    accumulation: int = hyperparameter(
        1,
        "Parts that the pairs of a step are computed in; more parts need less memory and more time.",
        minimum=1,
        maximum=4096,
    )
    learning_rate: float = hyperparameter(
        3e-4, "Highest learning rate of AdamW; for BART about 5e-5.", minimum=1e-7, maximum=1.0
    )
    warm_up: float = hyperparameter(
        0.06,
        "Share of the steps over which the learning rate grows; then it decays to 0.",
        minimum=0.0,
        maximum=0.9,
    )
    label_smoothing: float = hyperparameter(
        0.1, "Share of the target that is spread over all tokens.", minimum=0.0, maximum=0.9
    )
    clip: float = hyperparameter(
        1.0,
        "Largest norm of the gradient; larger ones are scaled down to it.",
        minimum=1e-3,
        maximum=1e6,
    )
    beam_width: int = hyperparameter(
        5,
        "Forms kept while decoding: in validation, and in prediction unless more are asked for.",
        1,
        100,
    )
    precision: str = hyperparameter(
        "auto",
        "Precision in training: bf16 where the processor supports it (auto), or always fp32.",
        choices=("auto", "fp32"),
    )
    threads: int = hyperparameter(
        0, "Processor cores to compute on; 0: all. Another number may round differently.", 0, 256
    )

    def __post_init__(self) -> None:
        validate(self)
        refuse_empty(self, "encoder")
