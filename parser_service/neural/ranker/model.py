"""The network of the form ranker: an encoder, and the heads that score forms with it."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

import torch
from torch import Tensor, nn
from torch.nn.functional import normalize

from annotations.language.forms import CLASS_TOKEN
from parser_service.neural.ranker.calibration import EXPERTS, Scores
from parser_service.neural.ranker.ranked_forms import RankedForms
from parser_service.neural.ranker.slots import SlotTerm
from parser_service.neural.ranker.unlisted_names import UnlistedNames
from parser_service.neural.sentence_encoder import SentenceEncoder
from parser_service.parsers.interface import Check, keep_going

SCALE = 20.0  # factor from a cosine to a logit
GLOSSES_AT_ONCE = 1024
SUPPORT_WEIGHT = 1.0  # nats for each kind of step that arrives at a new form


class PrototypeHead(nn.Module):
    """logit = 20 · cos(utterance, prototype) + bias, as in prototypical networks with learned
    prototypes (Snell et al. 2017)."""

    def __init__(self, forms: int, width: int):
        super().__init__()
        self.prototypes = nn.Parameter(torch.zeros(forms, width))
        self.bias = nn.Parameter(torch.zeros(forms))

    @torch.no_grad()
    def start_from(self, vectors: Tensor, forms: Sequence[int]) -> None:
        """Set each prototype to the mean of the vectors [examples, width] of its form's examples."""
        sums = torch.zeros_like(self.prototypes)
        sums.index_add_(0, torch.tensor(forms, device=vectors.device), vectors)
        self.prototypes.copy_(normalize(sums, dim=-1))

    def forward(self, utterances: Tensor) -> Tensor:
        """Return logits [batch, forms] for vectors of length 1 [batch, width]."""
        return SCALE * utterances @ normalize(self.prototypes, dim=-1).T + self.bias


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
        """Encode the next ``GLOSSES_AT_ONCE`` glosses, those of the ``turn``, in place of their older vectors."""
        turns = max(1, -(-len(self.glosses) // GLOSSES_AT_ONCE))
        begin = turn % turns * GLOSSES_AT_ONCE
        some = self.glosses[begin : begin + GLOSSES_AT_ONCE]
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


class RankerModel(nn.Module):
    """Scores forms by the nearest of their examples and by their glosses."""

    def __init__(
        self,
        encoder: SentenceEncoder,
        ranked: RankedForms,
        slots: SlotTerm | None = None,
        unlisted: UnlistedNames | None = None,
    ):
        """``slots`` and ``unlisted`` are given where the ontology is known."""
        super().__init__()
        self.encoder = encoder
        self.nearest = NearestExamples(ranked.examples, encoder.width)
        self.glosses = GlossHead(ranked.glosses, encoder.width)
        self.slots, self.unlisted = slots, unlisted
        self.known = ranked.known
        self.refused = ranked.refused
        self.support = torch.tensor(ranked.support, dtype=torch.float)  # [new forms]

    def trained(self) -> Iterator[tuple[str, nn.Parameter]]:
        """Yield the weights that training changes, by name: those of the encoder."""
        return ((name, weight) for name, weight in self.named_parameters() if weight.requires_grad)

    def add_slots(self, logits: Tensor, utterances: Sequence[str]) -> Tensor:
        """Add the slot term, where the ontology is known, to gloss logits [batch, forms]."""
        slots = self._slot_scores(utterances)
        return logits if slots is None else logits + slots.to(logits.device)

    def _slot_scores(self, utterances: Sequence[str]) -> Tensor | None:
        """Return scores [utterances, forms], where the ontology is known. What is no command has no slots, and any
        entities fit it."""
        if self.slots is None:
            return None
        scores = self.slots.scores(utterances)
        scores[:, self.refused] = 0.0
        return scores

    def encode(self, utterances: Sequence[str], check: Check) -> None:
        """Re-encode the glosses and ``utterances``, the examples, with the current encoder."""
        self.glosses.encode(self.encoder, check)
        self.nearest.encode(self.encoder, utterances, check)

    def hear(self, utterance: str, forms: Iterable[str], check: Check) -> Mapping[str, str]:
        """Return the entities, by class, that ``forms`` have slots for and that the utterance names in other words than
        the ontology."""
        if self.slots is None or self.unlisted is None:
            return {}
        asked = {name.rstrip("0123456789") for form in forms for name in CLASS_TOKEN.findall(form)}
        unnamed = sorted(asked.intersection(self.unlisted.tokens) - self.slots.named(utterance))
        return self.unlisted.find(self.encoder, utterance, unnamed, check) if unnamed else {}

    def rescored(self, scores: Scores, heard: Mapping[int, tuple[str, Collection[str]]]) -> Scores:
        """Return ``scores`` with the slots of some utterances, by number, scored with more entities of classes."""
        if self.slots is None or not heard:
            return scores
        known, new = scores.known.clone(), scores.new.clone()
        for number, (utterance, classes) in heard.items():
            row = self.slots.scores_with(utterance, classes)
            row[self.refused] = 0.0
            known[2, number], new[2, number] = row[: self.known], row[self.known :]
        return Scores(known, new)

    @torch.no_grad()
    def scores(self, utterances: Sequence[str], check: Check) -> Scores:
        """Return the scores of examples, glosses, slots and support, in the main memory."""
        vectors = self.encoder.vectors(utterances, check)  # [utterances, width]
        by_gloss = self.glosses.logits(vectors).cpu()  # [utterances, forms]
        scores = by_gloss.new_zeros(len(EXPERTS), *by_gloss.shape)
        by_example = self.nearest(vectors).cpu()  # [utterances, forms with examples]
        scores[0, :, : by_example.shape[1]] = by_example
        scores[1] = by_gloss
        if (slots := self._slot_scores(utterances)) is not None:
            scores[2] = slots
        scores[3, :, self.known :] = SUPPORT_WEIGHT * self.support
        return Scores(scores[..., : self.known], scores[..., self.known :])
