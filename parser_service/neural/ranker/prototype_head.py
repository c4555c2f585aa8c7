"""Scores forms with examples during training, by one learned vector each."""

from __future__ import annotations

from collections.abc import Sequence

import torch
from torch import Tensor, nn
from torch.nn.functional import normalize

SCALE = 20.0  # factor from a cosine to a logit


class PrototypeHead(nn.Module):
    """logit = 20 · cos(utterance, prototype) + bias, as in prototypical networks with learned
    prototypes (Snell et al. 2017)."""

    def __init__(self, forms: int, width: int):
        super().__init__()
        self.prototypes = nn.Parameter(torch.zeros(forms, width))
        self.bias = nn.Parameter(torch.zeros(forms))

    @torch.no_grad()
    def start_from(self, vectors: Tensor, forms: Sequence[int]) -> None:
        """Set each prototype to the mean of the vectors [examples, width] of its form's examples."""
        sums = torch.zeros_like(self.prototypes)
        sums.index_add_(0, torch.tensor(forms, device=vectors.device), vectors)
        self.prototypes.copy_(normalize(sums, dim=-1))

    def forward(self, utterances: Tensor) -> Tensor:
        """Return logits [batch, forms] for vectors of length 1 [batch, width]."""
        return SCALE * utterances @ normalize(self.prototypes, dim=-1).T + self.bias
