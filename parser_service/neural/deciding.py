"""From what the voices of a model say of known and of new forms to one list of calibrated probabilities."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from typing import Any, Self

import torch
from torch import Tensor
from torch.nn.functional import cross_entropy, logsigmoid

VOICES = ("examples", "glosses", "slots", "support")
Weights = tuple[float, ...]  # by VOICES
EQUAL: Weights = (1.0,) * len(VOICES)
SPREAD = 0.5  # of the logarithm of a weight, before validation has shown anything
OFFSETS = tuple(0.25 * step for step in range(-64, 33))  # nats
SLOPES = (0.0, 0.125, 0.25, 0.5, 1.0)
SUPPORT_LEFT_OUT = 3.0  # of a known form that is taken for new, whose steps nobody looked for


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

    def knows(self, forms: Tensor) -> Tensor:
        """Which of ``forms`` [utterances] are known, by their numbers (see ``calibrated``)."""
        return (forms >= 0) & (forms < self.known.shape[-1])

    def evidence_without(self, forms: Tensor) -> Tensor:
        """What ``evidence`` would be had training not shown each utterance's form of ``forms``
        [utterances], known forms all. Shape [utterances]."""
        meant = forms[:, None]
        new, known = self.new[1:].sum(0), self.known[1:].sum(0)
        left_out = known.gather(1, meant) + SUPPORT_LEFT_OUT
        known = known.scatter(1, meant, torch.finfo(known.dtype).min)
        return torch.cat([new, left_out], -1).logsumexp(-1) - known.logsumexp(-1)


@dataclass(frozen=True, slots=True)
class Decision:
    """How much each voice counts among known and among new forms, and when a form is new.

    The log-odds that it is new are ``novelty`` + ``slope`` · evidence.
    """

    novelty: float = 0.0
    slope: float = 1.0
    known: Weights = EQUAL
    new: Weights = EQUAL

    @classmethod
    def read(cls, values: Mapping[str, Any]) -> Self:
        """What ``dataclasses.asdict`` gave, once it was JSON."""
        return cls(values["novelty"], values["slope"], tuple(values["known"]), tuple(values["new"]))

    def log_probabilities(self, scores: Scores) -> Tensor:
        """Shape [utterances, known + new forms]; each row sums to 1 as probabilities."""
        known = torch.log_softmax(together(scores.known, self.known), -1)
        if not scores.new.shape[-1]:
            return known
        new = torch.log_softmax(together(scores.new, self.new), -1)
        odds = (self.novelty + self.slope * scores.evidence)[:, None]
        return torch.cat([known + logsigmoid(-odds), new + logsigmoid(odds)], -1)


def calibrated(scores: Scores, targets: Tensor) -> Decision:
    """The decision under which the forms [utterances] that were meant are most probable.

    ``targets`` number known forms first, then new ones; -1 for a form that is in neither list,
    which is a new one all the same.
    """
    number = scores.known.shape[-1]
    is_known, is_made = scores.knows(targets), targets >= number
    novelty, slope = calibrated_gate(scores, targets)
    return Decision(
        novelty,
        slope,
        best_weights(scores.known[:, is_known], targets[is_known]),
        best_weights(scores.new[:, is_made], targets[is_made] - number),
    )


def calibrated_gate(scores: Scores, targets: Tensor) -> tuple[float, float]:
    """Novelty and slope for utterances that mean the forms ``targets`` (see ``calibrated``).

    What a new form looks like is learned from known ones, too: each is taken for new.
    """
    is_known = scores.knows(targets)
    left_out = Scores(scores.known[:, is_known], scores.new[:, is_known])
    return best_gate(scores.evidence, ~is_known, left_out.evidence_without(targets[is_known]))


def best_gate(evidence: Tensor, is_new: Tensor, left_out: Tensor) -> tuple[float, float]:
    """Novelty and slope at which it is most probable which forms [utterances] were new.

    ``left_out`` is the evidence [utterances] of known forms taken for new. Half a pair is counted in
    that was new, at their mean surprise, and half a known one at the mean of the evidence, so that
    nothing becomes certain: pairs parted by command ask for a nearly closed set, those parted by form
    for an open one.
    """
    if not len(evidence):
        return 0.0, 1.0
    usual = evidence.mean()
    left_out = left_out if len(left_out) else usual[None]

    def surprise(gate: tuple[float, float]) -> float:
        offset, slope = gate
        odds = offset + slope * (evidence - usual)
        seen = logsigmoid(torch.where(is_new, odds, -odds)).sum()
        new = logsigmoid(offset + slope * (left_out - usual)).mean()
        known = logsigmoid(torch.tensor(-offset))
        return -float(seen + (new + known) / 2)

    offset, slope = min(product(OFFSETS, SLOPES), key=surprise)
    return offset - slope * float(usual), slope


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
