"""A learned mix of the layers of a frozen encoder, one vector per word."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor, nn


@dataclass(frozen=True, slots=True)
class ContextShape:
    """The shape of a frozen encoder's vectors of one word."""

    layers: int
    width: int


class ScalarMix(nn.Module):
    """gamma · Σ softmax(w)ₗ hₗ, with learned w and gamma (Peters et al. 2018, equation 1)."""

    def __init__(self, shape: ContextShape):
        super().__init__()
        self.width = shape.width
        self.weights = nn.Parameter(torch.zeros(shape.layers))
        self.gamma = nn.Parameter(torch.ones(1))

    def forward(self, layers: Tensor) -> Tensor:
        """Mix ``layers`` [batch, words, layers, width], in the main memory, to [batch, words, width]."""
        shares = torch.softmax(self.weights, dim=0)  # [layers]
        mixed = torch.einsum("bwld,l->bwd", layers.to(shares.device), shares)
        return self.gamma * mixed
