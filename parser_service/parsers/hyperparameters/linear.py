"""The hyperparameters of the linear classifier. Pages read them, so scikit-learn is not imported."""

from __future__ import annotations

from dataclasses import dataclass

from parser_service.parsers.hyperparameters.fields import hyperparameter, validate


@dataclass(frozen=True)
class LinearConfig:
    """How closely the weights follow the training pairs, and when to say UNKNOWN."""

    inverse_regularization: float = hyperparameter(
        30.0,
        "C of the logistic regression: the larger, the closer the weights follow the training pairs.",
        minimum=1e-3,
        maximum=1e6,
    )
    unknown_below: float = hyperparameter(
        0.0, "Probability below which the answer is UNKNOWN; 0: never.", 0.0, 1.0
    )

    def __post_init__(self) -> None:
        validate(self)
