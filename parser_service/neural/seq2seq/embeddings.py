"""Word vectors, and dropout with a random generator of its own."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from parser_service.neural.seq2seq.vocabulary import PADDING


class WordEmbedding(nn.Embedding):
    """A learned vector for each word; that of padding stays zero."""

    def __init__(self, words: int, size: int):
        super().__init__(words, size, padding_idx=PADDING)


class Dropout(nn.Module):
    """Inverted dropout. Its masks come from ``generator`` and not from torch's global one, so that
    nothing else in the process changes what is learned. The generator is on the CPU, so that the
    masks are the same on every processor."""

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
