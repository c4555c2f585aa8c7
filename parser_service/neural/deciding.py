"""From what the voices of a model say of known and of new forms to one list of calibrated probabilities."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import log
from typing import Any, Self

import torch
from torch import Tensor
from torch.nn.functional import cross_entropy, logsigmoid

VOICES = ("examples", "glosses", "slots", "support")
Weights = tuple[float, ...]  # by VOICES
EQUAL: Weights = (1.0,) * len(VOICES)
SPREAD = 0.5  # of the logarithm of a weight, before validation has shown anything
# New forms have to fit better than known ones by so many nats, found on splits by source command
# (docs/ranker.md); and the scale of what validation pairs may change in that.
USUAL_NOVELTY, NOVELTY_SCALE = -4.75, 0.2
NOVELTIES = tuple(0.05 * step for step in range(-320, 321))  # nats


@dataclass(frozen=True, slots=True)
class Scores:
    """What each voice of a model says to some utterances, in nats, higher for better.

    ``known`` [voices, utterances, known forms] and ``new`` [voices, utterances, new forms]; a voice
    that has nothing to say says 0 to all forms.
    """

    known: Tensor
    new: Tensor

    @property
    def evidence(self) -> Tensor:
        """By how much the new forms fit better than the known ones. Shape [utterances].

        Examples are left out, which only known forms have.
        """
        if not self.new.shape[-1]:
            return self.known.new_zeros(self.known.shape[1])
        return self.new[1:].sum(0).logsumexp(-1) - self.known[1:].sum(0).logsumexp(-1)


@dataclass(frozen=True, slots=True)
class Decision:
    """How much each voice counts among known and among new forms, and when a form is new.

    The log-odds that it is new are ``novelty`` + evidence.
    """

    novelty: float = USUAL_NOVELTY
    known: Weights = EQUAL
    new: Weights = EQUAL

    @classmethod
    def read(cls, values: Mapping[str, Any]) -> Self:
        """What ``dataclasses.asdict`` gave, once it was JSON."""
        return cls(values["novelty"], tuple(values["known"]), tuple(values["new"]))

    def log_probabilities(self, scores: Scores) -> Tensor:
        """Shape [utterances, known + new forms]; each row sums to 1 as probabilities."""
        known = torch.log_softmax(together(scores.known, self.known), -1)
        if not scores.new.shape[-1]:
            return known
        new = torch.log_softmax(together(scores.new, self.new), -1)
        odds = (self.novelty + scores.evidence)[:, None]
        return torch.cat([known + logsigmoid(-odds), new + logsigmoid(odds)], -1)


def calibrated(scores: Scores, targets: Tensor) -> Decision:
    """The decision under which the forms [utterances] that were meant are most probable.

    ``targets`` number known forms first, then new ones; -1 for a form that is in neither list,
    which is a new one all the same (all such count as one form).
    """
    number = scores.known.shape[-1]
    is_known, is_made = (targets >= 0) & (targets < number), targets >= number
    return Decision(
        best_novelty(scores.evidence, ~is_known, targets),
        best_weights(scores.known[:, is_known], targets[is_known]),
        best_weights(scores.new[:, is_made], targets[is_made] - number),
    )


def best_novelty(evidence: Tensor, is_new: Tensor, forms: Tensor) -> float:
    """The novelty at which it is most probable which of ``forms`` [utterances] were new.

    Pairs of one form are right or wrong together, so each form counts once. They speak against a Cauchy
    prior, which holds against a few and yields to many (O'Hagan 1979). Where all forms were new, the
    pairs are parted by form, and the set is open: the odds are those of as many pairs and half a known
    one (Krichevsky and Trofimov 1981).
    """
    if not len(forms):
        return USUAL_NOVELTY
    if is_new.all():
        return log(1 + 2 * len(forms))
    _, at, pairs = forms.unique(return_inverse=True, return_counts=True)
    novelties = torch.tensor(NOVELTIES)
    odds = novelties[:, None] + evidence  # [novelties, utterances]
    seen = (logsigmoid(torch.where(is_new, odds, -odds)) / pairs[at]).sum(-1)
    prior = -torch.log1p(((novelties - USUAL_NOVELTY) / NOVELTY_SCALE).square())
    return NOVELTIES[int((seen + prior).argmax())]


def best_weights(scores: Tensor, targets: Tensor) -> Weights:
    """The weights of the voices at which ``targets`` are most probable; 1 where nothing is to be seen.

    A log-linear pool of opinions (Genest and Zidek 1986) by maximum a posteriori: before any pair
    each weight is log-normal around 1, so that a few pairs cannot silence a voice.
    """
    logarithms = torch.zeros(len(scores), dtype=torch.double, requires_grad=True)
    said = scores.double()
    search = torch.optim.LBFGS([logarithms], max_iter=100, line_search_fn="strong_wolfe")

    def surprise() -> Tensor:
        search.zero_grad()
        seen = cross_entropy(together(said, logarithms.exp()), targets, reduction="sum")
        loss = seen + logarithms.square().sum() / (2 * SPREAD**2)
        loss.backward()  # type: ignore[no-untyped-call]
        return loss

    if len(targets):
        search.step(surprise)  # type: ignore[no-untyped-call]
    return tuple(logarithms.detach().exp().tolist())


def together(scores: Tensor, weights: Weights | Tensor) -> Tensor:
    """The weighted sum of the voices. Shape [voices, utterances, forms] to [utterances, forms]."""
    shares = torch.as_tensor(weights, dtype=scores.dtype)
    return torch.einsum("v,vuf->uf", shares, scores)
