"""Scores forms by the nearest of their examples, in the vector space of the encoder."""

from __future__ import annotations

from collections.abc import Sequence

import torch
from torch import Tensor, nn

from parser_service.neural.ranker.prototype_head import SCALE
from parser_service.neural.sentence_encoder import SentenceEncoder
from parser_service.parsers.interface import Check, keep_going


class NearestExamples(nn.Module):
    """logit = 20 · cos(utterance, nearest example of the form) (Cover and Hart 1967).

    It has no weights of its own. The vectors are saved with those of the encoder.
    """

    vectors: Tensor  # [examples, width], zero before the first ``encode``
    forms: Tensor  # [examples], the number of the form of each

    def __init__(self, forms: Sequence[int], width: int):
        super().__init__()
        self.register_buffer("vectors", torch.zeros(len(forms), width))
        self.register_buffer("forms", torch.tensor(forms, dtype=torch.long), persistent=False)
        self.number = 1 + max(forms, default=-1)  # of forms

    def encode(
        self, encoder: SentenceEncoder, utterances: Sequence[str], check: Check = keep_going
    ) -> None:
        """Encode ``utterances``, the examples, with the current ``encoder``."""
        self.vectors.copy_(encoder.vectors(utterances, check))

    def forward(self, utterances: Tensor) -> Tensor:
        """Return logits [batch, forms] for vectors of length 1 [batch, width]; a form without an example
        has the lowest possible one."""
        near = SCALE * utterances @ self.vectors.T  # [batch, examples]
        far = near.new_full((len(near), self.number), -SCALE)
        return far.scatter_reduce(1, self.forms.expand(len(near), -1), near, "amax")
