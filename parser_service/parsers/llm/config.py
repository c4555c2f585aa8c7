"""The hyperparameters of the parser that asks a language model."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from parser_service.parsers.hyperparameters.fields import hyperparameter, validate

LISTED, FREE = "listed", "free"


@dataclass(frozen=True)
class LanguageModelConfig:
    """Which model to ask, and how. The address and the key come from the environment alone."""

    needs_server: ClassVar[bool] = True

    model: str = hyperparameter(
        "", "Name of the model, as its server lists it.", is_required=True, longest=200
    )
    decoding: str = hyperparameter(
        LISTED,
        "listed: the model chooses among forms of training; free: it writes one.",
        choices=(LISTED, FREE),
    )
    examples: int = hyperparameter(
        12, "Nearest training pairs that are shown to the model.", minimum=1, maximum=100
    )
    forms: int = hyperparameter(
        24,
        "Forms of the nearest pairs that the model may choose from (listed).",
        minimum=1,
        maximum=500,
    )
    max_tokens: int = hyperparameter(
        1024, "Tokens that an answer may have, thinking included.", minimum=16, maximum=65_536
    )
    at_once: int = hyperparameter(
        4, "Questions that the server is asked at the same time.", minimum=1, maximum=64
    )

    def __post_init__(self) -> None:
        validate(self)
