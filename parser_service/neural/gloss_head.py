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

    def read(self, texts: Sequence[str], targets: Sequence[int]) -> tuple[Tensor, Tensor]:
        """Vectors [batch, width] and logits [batch, glosses] of ``texts``, with gradient to them and to
        the glosses of ``targets``, a form for each: all in one pass through the encoder."""
        own = sorted(set(targets))
        found = self.encoder([*texts, *(self.glosses[index] for index in own)])
        utterances, fresh = found[: len(texts)], found[len(texts) :]
        at = torch.tensor(own, device=found.device)
        return utterances, SCALE * utterances @ self.vectors.index_copy(0, at, fresh).T
