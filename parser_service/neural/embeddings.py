"""Word vectors, and dropout that draws from a generator of its own."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from parser_service.neural.vocabulary import PADDING


class WordEmbedding(nn.Embedding):
    """A learned vector for each word; padding is the zero vector and stays it."""

    def __init__(self, words: int, size: int):
        super().__init__(words, size, padding_idx=PADDING)


class Dropout(nn.Module):
    """Inverted dropout. Its masks come from ``generator`` and not from torch's global one, so that
    nothing else that runs in the process changes what is learned. It lives on the CPU, so that
    every processor drops the same."""

    def __init__(self, probability: float, generator: torch.Generator):
        super().__init__()
        self.probability = probability
        self.generator = generator

    def forward(self, values: Tensor) -> Tensor:
        if not self.training or self.probability == 0:
            return values
        keep = 1 - self.probability
        mask = torch.empty_like(values, device="cpu").bernoulli_(keep, generator=self.generator)
        return values * mask.to(values.device) / keep  # as values
