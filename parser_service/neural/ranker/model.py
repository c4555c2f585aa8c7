"""The network of the form ranker: an encoder, and the heads that score forms with it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import torch
from torch import Tensor, nn

from parser_service.neural.ranker.calibration import EXPERTS, Scores
from parser_service.neural.ranker.gloss_head import GlossHead
from parser_service.neural.ranker.nearest_examples import NearestExamples
from parser_service.neural.ranker.ranked_forms import RankedForms
from parser_service.neural.ranker.slot_term import SlotTerm
from parser_service.neural.sentence_encoder import SentenceEncoder
from parser_service.parsers.interface import Check

SUPPORT_WEIGHT = 1.0  # nats for each kind of step that arrives at a new form


class RankerModel(nn.Module):
    """Scores forms by the nearest of their examples and by their glosses."""

    def __init__(
        self, encoder: SentenceEncoder, ranked: RankedForms, slots: SlotTerm | None = None
    ):
        """``slots`` is given where the ontology is known."""
        super().__init__()
        self.encoder = encoder
        self.nearest = NearestExamples(ranked.examples, encoder.width)
        self.glosses = GlossHead(ranked.glosses, encoder.width)
        self.slots = slots
        self.known = ranked.known
        self.support = torch.tensor(ranked.support, dtype=torch.float)  # [new forms]

    def trained(self) -> Iterator[tuple[str, nn.Parameter]]:
        """Yield the weights that training changes, by name: those of the encoder."""
        return ((name, weight) for name, weight in self.named_parameters() if weight.requires_grad)

    def add_slots(self, logits: Tensor, utterances: Sequence[str]) -> Tensor:
        """Add the slot term, where the ontology is known, to gloss logits [batch, forms]."""
        if self.slots is None:
            return logits
        return logits + self.slots.scores(utterances).to(logits.device)

    def encode(self, utterances: Sequence[str], check: Check) -> None:
        """Re-encode the glosses and ``utterances``, the examples, with the current encoder."""
        self.glosses.encode(self.encoder, check)
        self.nearest.encode(self.encoder, utterances, check)

    @torch.no_grad()
    def scores(self, utterances: Sequence[str], check: Check) -> Scores:
        """Return the scores of examples, glosses, slots and support, in the main memory."""
        vectors = self.encoder.vectors(utterances, check)  # [utterances, width]
        by_gloss = self.glosses.logits(vectors).cpu()  # [utterances, forms]
        scores = by_gloss.new_zeros(len(EXPERTS), *by_gloss.shape)
        by_example = self.nearest(vectors).cpu()  # [utterances, forms with examples]
        scores[0, :, : by_example.shape[1]] = by_example
        scores[1] = by_gloss
        if self.slots is not None:
            scores[2] = self.slots.scores(utterances)
        scores[3, :, self.known :] = SUPPORT_WEIGHT * self.support
        return Scores(scores[..., : self.known], scores[..., self.known :])
