"""The network of the form ranker: an encoder and the prototypes of forms with examples."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import torch
from torch import Tensor, nn

from parser_service.neural.deciding import Scores
from parser_service.neural.gloss_head import GlossHead
from parser_service.neural.prototype_head import PrototypeHead
from parser_service.neural.ranked_forms import RankedForms
from parser_service.neural.sentence_encoder import SentenceEncoder
from parser_service.neural.slot_term import SlotTerm
from parser_service.parsers.interface import Check

SUPPORT_WEIGHT = 1.0  # nats for each kind of step that arrives at a new form


class RankerModel(nn.Module):
    """Scores forms in two ways: against the examples that they had, and against their glosses."""

    def __init__(
        self, encoder: SentenceEncoder, ranked: RankedForms, slots: SlotTerm | None = None
    ):
        """``slots`` where the ontology is known."""
        super().__init__()
        self.encoder = encoder
        self.prototypes = PrototypeHead(ranked.examples, encoder.width)
        self.glosses = GlossHead(encoder, ranked.glosses)
        self.slots = slots
        self.known = ranked.known
        self.support = torch.tensor(ranked.support, dtype=torch.float)  # [new forms]

    def trained(self) -> Iterator[tuple[str, nn.Parameter]]:
        """The weights that training moves, by name."""
        return ((name, weight) for name, weight in self.named_parameters() if weight.requires_grad)

    def encoder_weights(self) -> Iterator[tuple[str, nn.Parameter]]:
        """Those of them that the encoder was pretrained with."""
        return ((name, weight) for name, weight in self.trained() if name.startswith("encoder."))

    def fitting(self, logits: Tensor, utterances: Sequence[str]) -> Tensor:
        """Gloss logits [batch, forms] with the slot term, where the ontology is known."""
        if self.slots is None:
            return logits
        return logits + self.slots.scores(utterances).to(logits.device)

    @torch.no_grad()
    def scores(self, utterances: Sequence[str], check: Check) -> Scores:
        """What prototypes, glosses, slots and support say, in the main memory."""
        vectors = self.encoder.vectors(utterances, check)  # [utterances, width]
        by_example = self.prototypes(vectors).cpu()  # [utterances, forms with examples]
        by_gloss = self.fitting(self.glosses.logits(vectors), utterances).cpu()
        known, new = by_gloss[:, : self.known], by_gloss[:, self.known :]
        new = new + SUPPORT_WEIGHT * self.support
        is_open = new.shape[1] > 0
        evidence = (
            new.logsumexp(-1) - known.logsumexp(-1) if is_open else known.new_zeros(len(known))
        )
        return Scores(
            _added(known, by_example[:, : self.known]),
            _added(new, by_example[:, self.known :]),
            evidence,
        )


def _added(by_gloss: Tensor, by_example: Tensor) -> Tensor:
    """The log-probabilities of both ways for some forms, of glosses alone where there is no example.
    Shape [utterances, forms]."""
    logs = torch.log_softmax(by_gloss, -1)
    return logs + torch.log_softmax(by_example, -1) if by_example.shape[1] else logs
