"""Bilinear attention: how much each word of the utterance matters for the next token of the form."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from parser_service.neural.seq2seq.encoder import Encoded


class BilinearAttention(nn.Module):
    """Weights softmax(q W kᵀ) (Luong et al. 2015, "general")."""

    def __init__(self, hidden_size: int):
        super().__init__()
        self.weight = nn.Linear(hidden_size, hidden_size, bias=False)

    def forward(self, queries: Tensor, encoded: Encoded) -> Tensor:
        """Return the attended states for ``queries`` [batch, target length, hidden], of the same shape."""
        keys = encoded.states.transpose(1, 2)  # [batch, hidden, source length]
        scores = torch.bmm(self.weight(queries), keys)  # [batch, target length, source length]
        scores = scores.masked_fill(~encoded.mask[:, None, :], float("-inf"))
        weights = torch.softmax(scores, dim=-1)  # [batch, target length, source length]
        return torch.bmm(weights, encoded.states)  # [batch, target length, hidden]
