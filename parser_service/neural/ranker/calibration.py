"""Combines the scores of the experts of a model, for known and for new forms, into calibrated
probabilities."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import log
from typing import Any, Self

import torch
from torch import Tensor
from torch.nn.functional import cross_entropy, logsigmoid

EXPERTS = ("examples", "glosses", "slots", "support")
Weights = tuple[float, ...]  # by EXPERTS
# What a log-probability is the sum of: the experts, whether the form is new, and how well others fit.
TERMS = (*EXPERTS, "novelty", "others")
EQUAL: Weights = (1.0,) * len(EXPERTS)
SPREAD = 0.5  # standard deviation of the prior of the logarithm of a weight
# By how many nats new forms have to fit better than known ones, negated, and the scale of the prior
# around it, from which validation pairs move it: measured on splits by source command (docs/ranker.md).
USUAL_NOVELTY, NOVELTY_SCALE = -4.75, 0.2
NOVELTIES = tuple(0.05 * step for step in range(-320, 321))  # nats


@dataclass(frozen=True, slots=True)
class Scores:
    """The scores of each expert of a model for some utterances, in nats, higher for better.

    ``known`` [experts, utterances, known forms] and ``new`` [experts, utterances, new forms]; an
    expert without an opinion scores all forms 0.
    """

    known: Tensor
    new: Tensor

    @property
    def evidence(self) -> Tensor:
        """Return by how much the new forms fit better than the known ones. Shape [utterances].

        Examples are left out, because only known forms have them.
        """
        if not self.new.shape[-1]:
            return self.known.new_zeros(self.known.shape[1])
        return self.new[1:].sum(0).logsumexp(-1) - self.known[1:].sum(0).logsumexp(-1)


@dataclass(frozen=True, slots=True)
class Decision:
    """The weight of each expert among known and among new forms, and when a form is new.

    The log-odds that it is new are ``novelty`` + evidence.
    """

    novelty: float = USUAL_NOVELTY
    known: Weights = EQUAL
    new: Weights = EQUAL

    @classmethod
    def read(cls, values: Mapping[str, Any]) -> Self:
        """Read what ``dataclasses.asdict`` returned, after it was JSON."""
        return cls(values["novelty"], tuple(values["known"]), tuple(values["new"]))

    def log_probabilities(self, scores: Scores) -> Tensor:
        """Return log-probabilities [utterances, known + new forms]; the probabilities of a row sum to 1."""
        known = torch.log_softmax(combine(scores.known, self.known), -1)
        if not scores.new.shape[-1]:
            return known
        new = torch.log_softmax(combine(scores.new, self.new), -1)
        odds = (self.novelty + scores.evidence)[:, None]
        return torch.cat([known + logsigmoid(-odds), new + logsigmoid(odds)], -1)

    def terms(self, scores: Scores, forms: Tensor) -> Tensor:
        """Return the ``TERMS`` of the log-probabilities of ``forms`` [utterances, answers], in nats.

        Shape [terms, utterances, answers]. They sum to the log-probability: the weighted score of each
        expert; the logarithm of the probability that the form is known, or new, whichever this one is;
        and minus the logarithm of the sum over all forms that are known, or new.
        """
        weighted = [
            part * torch.tensor(weights)[:, None, None]
            for part, weights in ((scores.known, self.known), (scores.new, self.new))
        ]
        experts = torch.cat(weighted, -1).gather(2, forms.expand(len(EXPERTS), -1, -1))
        novelty = torch.zeros_like(experts[0])
        if scores.new.shape[-1]:
            odds = (self.novelty + scores.evidence)[:, None]
            novelty = logsigmoid(torch.where(forms >= scores.known.shape[-1], odds, -odds))
        total = self.log_probabilities(scores).gather(1, forms)
        others = total - novelty - experts.sum(0)
        return torch.cat([experts, novelty[None], others[None]])


def calibrate(scores: Scores, targets: Tensor) -> Decision:
    """Return the decision under which ``targets`` [utterances] are most probable.

    Targets number known forms first, then new ones; -1 is a form that is in neither list, which counts
    as a new one (all such forms count as one).
    """
    number = scores.known.shape[-1]
    is_known, is_made = (targets >= 0) & (targets < number), targets >= number
    return Decision(
        best_novelty(scores.evidence, ~is_known, targets),
        best_weights(scores.known[:, is_known], targets[is_known]),
        best_weights(scores.new[:, is_made], targets[is_made] - number),
    )


def best_novelty(evidence: Tensor, is_new: Tensor, forms: Tensor) -> float:
    """Return the novelty that best explains which of ``forms`` [utterances] are new.

    Pairs of one form are right or wrong together, so each form counts once. The prior is a Cauchy
    distribution, which a few forms hardly move and many do (O'Hagan 1979). Where all forms are new,
    the split is by form and the set is open: the odds are those of as many new pairs and half a known
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
    """Return the weights of the experts at which ``targets`` are most probable; 1 without targets.

    A log-linear pool of opinions (Genest and Zidek 1986) by maximum a posteriori. The prior of each
    weight is log-normal around 1, so that a few pairs cannot silence an expert.
    """
    logarithms = torch.zeros(len(scores), dtype=torch.double, requires_grad=True)
    in_double = scores.double()
    search = torch.optim.LBFGS([logarithms], max_iter=100, line_search_fn="strong_wolfe")

    def negative_log_posterior() -> Tensor:
        search.zero_grad()
        seen = cross_entropy(combine(in_double, logarithms.exp()), targets, reduction="sum")
        loss = seen + logarithms.square().sum() / (2 * SPREAD**2)
        loss.backward()  # type: ignore[no-untyped-call]
        return loss

    if len(targets):
        search.step(negative_log_posterior)  # type: ignore[no-untyped-call]
    return tuple(logarithms.detach().exp().tolist())


def combine(scores: Tensor, weights: Weights | Tensor) -> Tensor:
    """Return the weighted sum of the experts. Shape [experts, utterances, forms] to [utterances, forms]."""
    shares = torch.as_tensor(weights, dtype=scores.dtype)
    return torch.einsum("e,euf->uf", shares, scores)
