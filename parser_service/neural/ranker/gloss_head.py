"""Scores forms by their English glosses, read by the encoder that reads the utterances."""

from __future__ import annotations

from collections.abc import Sequence

import torch
from torch import Tensor, nn

from parser_service.neural.ranker.prototype_head import SCALE
from parser_service.neural.sentence_encoder import SentenceEncoder
from parser_service.parsers.interface import Check, keep_going

AT_ONCE = 1024  # glosses


class GlossHead(nn.Module):
    """logit = 20 · cos(utterance, gloss). It has no weights of its own, so it also scores forms that
    training never showed.

    In training the glosses of a batch's own forms carry gradient; the vectors of the others are
    re-encoded from time to time, of very many glosses some each time. The vectors are saved with the
    weights: encoding a thousand glosses takes longer than everything else that loading does.
    """

    vectors: Tensor  # [glosses, width], zero before the first ``encode``

    def __init__(self, glosses: Sequence[str], width: int):
        super().__init__()
        self.glosses = tuple(glosses)
        self.register_buffer("vectors", torch.zeros(len(self.glosses), width))

    def encode(self, encoder: SentenceEncoder, check: Check = keep_going) -> None:
        """Encode the glosses with the current ``encoder``."""
        self.vectors = encoder.vectors(self.glosses, check)

    @torch.no_grad()
    def refresh(self, encoder: SentenceEncoder, turn: int, check: Check = keep_going) -> None:
        """Encode the next ``AT_ONCE`` glosses, those of the ``turn``, in place of their older vectors."""
        turns = max(1, -(-len(self.glosses) // AT_ONCE))
        begin = turn % turns * AT_ONCE
        some = self.glosses[begin : begin + AT_ONCE]
        self.vectors[begin : begin + len(some)] = encoder.vectors(some, check)

    def logits(self, utterances: Tensor) -> Tensor:
        """Return logits [batch, glosses] for ``utterances`` [batch, width]."""
        return SCALE * utterances @ self.vectors.T

    def read(
        self, encoder: SentenceEncoder, texts: Sequence[str], targets: Sequence[int]
    ) -> tuple[Tensor, Tensor]:
        """Return vectors [batch, width] and logits [batch, glosses] of ``texts``.

        Gradient flows to the texts and to the glosses of ``targets``, one form for each text: all
        go through the encoder in one pass.
        """
        own = sorted(set(targets))
        encoded = encoder([*texts, *(self.glosses[index] for index in own)])
        utterances, fresh = encoded[: len(texts)], encoded[len(texts) :]
        at = torch.tensor(own, device=encoded.device)
        return utterances, SCALE * utterances @ self.vectors.index_copy(0, at, fresh).T
