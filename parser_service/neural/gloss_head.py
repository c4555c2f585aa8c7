"""Forms by what they say in English: through the encoder that reads the utterances."""

from __future__ import annotations

from collections.abc import Sequence

import torch
from torch import Tensor

from parser_service.neural.prototype_head import SCALE
from parser_service.neural.sentence_encoder import SentenceEncoder
from parser_service.parsers.interface import Check, keep_going


class GlossHead:
    """logit = 20 · cos(utterance, gloss), without a weight of its own, so that it serves a form that
    training never showed.

    In training the glosses of a batch's own forms carry gradient; the vectors of the others are
    renewed now and then.
    """

    def __init__(self, encoder: SentenceEncoder, glosses: Sequence[str]):
        self.encoder = encoder
        self.glosses = tuple(glosses)
        self.vectors = torch.zeros(0, encoder.width)  # [glosses, width]

    def renew(self, check: Check = keep_going) -> None:
        """Computes the vectors of the glosses with the encoder as it is."""
        self.vectors = self.encoder.vectors(self.glosses, check)

    def logits(self, utterances: Tensor) -> Tensor:
        """Shape [batch, width] to [batch, glosses]."""
        return SCALE * utterances @ self.vectors.T

    def trained_logits(self, utterances: Tensor, targets: Sequence[int]) -> Tensor:
        """The same with gradient to the glosses of ``targets``, a form for each utterance."""
        own = sorted(set(targets))
        fresh = self.encoder([self.glosses[index] for index in own])
        at = torch.tensor(own, device=fresh.device)
        vectors = self.vectors.index_copy(0, at, fresh)
        return SCALE * utterances @ vectors.T
