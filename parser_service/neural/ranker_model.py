"""The network of the form ranker: an encoder and the prototypes of forms with examples."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from torch import Tensor, nn

from parser_service.neural.gloss_head import GlossHead
from parser_service.neural.prototype_head import PrototypeHead
from parser_service.neural.sentence_encoder import SentenceEncoder
from parser_service.neural.slot_term import SlotTerm


class RankerModel(nn.Module):
    """Scores forms in two ways: against the examples that they had, and against their glosses.

    ``glosses`` are those of all forms; the first ``examples`` of them have examples and therefore
    a prototype.
    """

    def __init__(
        self,
        encoder: SentenceEncoder,
        glosses: Sequence[str],
        examples: int,
        slots: SlotTerm | None = None,
    ):
        super().__init__()
        self.encoder = encoder
        self.prototypes = PrototypeHead(examples, encoder.width)
        self.glosses = GlossHead(encoder, glosses)
        self.slots = slots

    @property
    def examples(self) -> int:
        """How many forms have a prototype."""
        return len(self.prototypes.bias)

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
