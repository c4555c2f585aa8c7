"""The hyperparameters of the row with OpenAI's GPT. Pages read them, so torch is not imported."""

from __future__ import annotations

from dataclasses import dataclass

from parser_service.parsers.hyperparameters.vectors import GloveTransformerConfig, frozen_encoder


@dataclass(frozen=True)
class GloveGptConfig(GloveTransformerConfig):
    encoder: str = frozen_encoder("openai-community/openai-gpt")
