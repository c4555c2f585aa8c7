"""Forms by the nearest of their examples, in the space of the encoder."""

from __future__ import annotations

from collections.abc import Sequence

import torch
from torch import Tensor, nn

from parser_service.neural.prototype_head import SCALE
from parser_service.neural.sentence_encoder import SentenceEncoder
from parser_service.parsers.interface import Check, keep_going


class NearestExamples(nn.Module):
    """logit = 20 · cos(utterance, nearest example of the form) (Cover and Hart 1967).

    Nothing is learned here but by the encoder. The vectors are kept with its weights.
    """

    vectors: (
        Tensor  # [examples, width], zero before the first renewal: nothing is nearer than the rest
    )
    forms: Tensor  # [examples], the number of the form of each

    def __init__(self, forms: Sequence[int], width: int):
        super().__init__()
        self.register_buffer("vectors", torch.zeros(len(forms), width))
        self.register_buffer("forms", torch.tensor(forms, dtype=torch.long), persistent=False)
        self.number = 1 + max(forms, default=-1)  # of forms

    def renew(
        self, encoder: SentenceEncoder, utterances: Sequence[str], check: Check = keep_going
    ) -> None:
        """Computes the vectors of ``utterances``, the examples, with the encoder as it is."""
        self.vectors.copy_(encoder.vectors(utterances, check))

    def forward(self, utterances: Tensor) -> Tensor:
        """Logits from vectors of length 1. Shape [batch, width] to [batch, forms]; a form without an
        example is as far away as can be."""
        near = SCALE * utterances @ self.vectors.T  # [batch, examples]
        far = near.new_full((len(near), self.number), -SCALE)
        return far.scatter_reduce(1, self.forms.expand(len(near), -1), near, "amax")
