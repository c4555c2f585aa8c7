"""The network of the form ranker: an encoder, and forms by their examples and by their glosses."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import torch
from torch import Tensor, nn

from parser_service.neural.deciding import VOICES, Scores
from parser_service.neural.gloss_head import GlossHead
from parser_service.neural.nearest_examples import NearestExamples
from parser_service.neural.prototype_head import PrototypeHead
from parser_service.neural.ranked_forms import RankedForms
from parser_service.neural.sentence_encoder import SentenceEncoder
from parser_service.neural.slot_term import SlotTerm
from parser_service.parsers.interface import Check

ASKED_AT_ONCE = 32  # utterances; with more, short ones are padded to long ones
SUPPORT_WEIGHT = 1.0  # nats for each kind of step that arrives at a new form


class RankerModel(nn.Module):
    """Scores forms in two ways: against their examples and against their glosses.

    In training a prototype stands for the examples of a form, which have no vectors of the day;
    afterwards the nearest of them speaks.
    """

    def __init__(
        self, encoder: SentenceEncoder, ranked: RankedForms, slots: SlotTerm | None = None
    ):
        """``slots`` where the ontology is known."""
        super().__init__()
        self.encoder = encoder
        self.nearest = NearestExamples(ranked.examples, encoder.width)
        self.prototypes = PrototypeHead(self.nearest.number, encoder.width)
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

    def renew(self, utterances: Sequence[str], check: Check) -> None:
        """Puts ``utterances``, the examples, and the glosses where the encoder puts them by now."""
        self.glosses.renew(check)
        self.nearest.renew(self.encoder, utterances, check)

    @torch.no_grad()
    def scores(self, utterances: Sequence[str], check: Check) -> Scores:
        """What examples, glosses, slots and support say, in the main memory."""
        vectors = self.encoder.vectors(utterances, check, ASKED_AT_ONCE)  # [utterances, width]
        by_gloss = self.glosses.logits(vectors).cpu()  # [utterances, forms]
        said = by_gloss.new_zeros(len(VOICES), *by_gloss.shape)
        by_example = self.nearest(vectors).cpu()  # [utterances, forms with examples]
        said[0, :, : by_example.shape[1]] = by_example
        said[1] = by_gloss
        if self.slots is not None:
            said[2] = self.slots.scores(utterances)
        said[3, :, self.known :] = SUPPORT_WEIGHT * self.support
        return Scores(said[..., : self.known], said[..., self.known :])
