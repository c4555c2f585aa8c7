"""Combines the scores of the experts of a model, for known and for new forms, into calibrated
probabilities."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
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
# How much the nearest example says about whether a form is new, beside the glosses, and how near one
# has to be to say that it is known (docs/research/ranker-experiments.md).
NEAREST_SHARE = 0.5
NEAR = 11.0  # nats; a cosine of 0.55
# A command means a new form a fifth as often as a known one. This is the novelty where nothing was held
# out, too, and the scale of the prior around it.
USUAL_NOVELTY, NOVELTY_SCALE = log(1 / 5), 0.5
NOVELTIES = tuple(0.05 * step for step in range(-200, 201))  # nats
LABEL_NOISE = 0.05  # share of the pairs that are taken to have any form
WITHHELD = 0.05  # most of the right answers that may be withheld, to answer nothing that is unlike all examples
USUAL_NEARNESS = 11.0  # nats; the bound where too few answers tell one
TELLING = 40  # right answers


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
        """Return by how much the best new form fits better than the best known one. Shape [utterances].

        Forms that fit worse say nothing, so ten of them are like ten thousand. The examples are
        weighed apart, because most new forms have none.
        """
        if not self.new.shape[-1]:
            return self.known.new_zeros(self.known.shape[1])
        return _fit(self.new) - _fit(self.known)

    @property
    def nearness(self) -> Tensor:
        """Return how near the nearest example or gloss of any form is, in nats. Shape [utterances]."""
        parts = [part[:2].amax((0, 2)) for part in (self.known, self.new) if part.shape[-1]]
        return torch.stack(parts).amax(0)


@dataclass(frozen=True, slots=True)
class DecisionRule:
    """The weight of each expert among known and among new forms, and when a form is new.

    The log-odds that it is new are ``novelty`` + evidence. An utterance below ``least_nearness`` is like
    nothing that was learned (``Scores.nearness``).
    """

    novelty: float = USUAL_NOVELTY
    known: Weights = EQUAL
    new: Weights = EQUAL
    least_nearness: float = USUAL_NEARNESS

    @classmethod
    def read(cls, values: Mapping[str, Any]) -> Self:
        """Read what ``dataclasses.asdict`` returned, after it was JSON."""
        return cls(
            values["novelty"],
            tuple(values["known"]),
            tuple(values["new"]),
            values.get("least_nearness", USUAL_NEARNESS),
        )

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


def weigh(
    novelty: float, scores: Scores, targets: Tensor, spoken: Tensor | None = None
) -> DecisionRule:
    """Return the decision with the weights at which ``targets`` [utterances] are most probable among the
    known forms, and among the new ones; and with the bound of nearness that withholds ``WITHHELD`` of the
    right answers.

    Targets number known forms first, then new ones; -1 is a form that is in neither list. The bound is learned from
    the utterances that ``spoken`` [utterances] names: what people say is less like the examples than what a
    grammar generates. Where it names none, the bound is the usual one.
    """
    number = scores.known.shape[-1]
    is_known, is_made = (targets >= 0) & (targets < number), targets >= number
    decision = DecisionRule(
        novelty,
        best_weights(scores.known[:, is_known], targets[is_known]),
        best_weights(scores.new[:, is_made], targets[is_made] - number),
    )
    is_right = decision.log_probabilities(scores).argmax(-1) == targets
    is_right &= torch.zeros_like(is_right) if spoken is None else spoken
    return replace(decision, least_nearness=least_nearness(scores.nearness[is_right]))


def least_nearness(of_right: Tensor) -> float:
    """Return the bound below which ``WITHHELD`` of ``of_right`` lie at most: the nearness of utterances that
    were answered right. Few of them are no evidence against a lower bound than usual.

    It is halfway to the next below, since nearness is rounded otherwise among other utterances: at the bound
    itself an utterance would be refused in one batch and answered in another.
    """
    if not len(of_right):
        return USUAL_NEARNESS
    ordered, place = of_right.sort().values, int(WITHHELD * len(of_right))
    bound = float(ordered[max(0, place - 1)] + ordered[place]) / 2
    return bound if len(of_right) >= TELLING else min(bound, USUAL_NEARNESS)


def best_novelty(
    of_new: Tensor, new_forms: Sequence[str], of_known: Tensor, known_forms: Sequence[str]
) -> float:
    """Return the novelty that best tells utterances of new forms from those of known ones.

    Args:
        of_new: the evidence for utterances of forms that training did not show. Shape [utterances].
        new_forms: the form of each.
        of_known: the evidence for utterances of the other forms.
        known_forms: the form of each.

    New and known forms count alike, however many there are of each, and so do all forms of one kind:
    pairs of one form are right or wrong together. New forms are meant less often than they are held out,
    which ``USUAL_NOVELTY`` says. A share of ``LABEL_NOISE`` of the pairs may have any
    form, so that a wrong one costs a few nats at most. The prior is a Cauchy distribution around
    ``USUAL_NOVELTY``, which a few forms hardly move and many do (O'Hagan 1979).
    """
    if not new_forms or not known_forms:
        return USUAL_NOVELTY
    novelties = torch.tensor(NOVELTIES)
    pulls = novelties[:, None]
    seen = _mean_by_form(_noisy(pulls + of_new), new_forms)
    seen = seen + _mean_by_form(_noisy(-pulls - of_known), known_forms)
    forms = min(len(set(new_forms)), len(set(known_forms)))
    prior = -torch.log1p((novelties / NOVELTY_SCALE).square())
    return USUAL_NOVELTY + NOVELTIES[int((forms * seen + prior).argmax())]


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


def _fit(scores: Tensor) -> Tensor:
    """Return how well the best of some forms [experts, utterances, forms] fit. Shape [utterances].

    Forms without examples count as if their nearest example were just ``NEAR``.
    """
    examples, others = scores[0], scores[1:].sum(0)
    nearest = examples.amax(-1) if examples.any() else NEAR
    return others.amax(-1) + NEAREST_SHARE * (nearest - NEAR)


def _noisy(odds: Tensor) -> Tensor:
    """Return the log-probability of what has the log-odds ``odds``, where some labels are wrong."""
    return torch.log(LABEL_NOISE / 2 + (1 - LABEL_NOISE) * torch.sigmoid(odds))


def _mean_by_form(values: Tensor, forms: Sequence[str]) -> Tensor:
    """Return the mean over forms of the mean over their utterances. Shape [..., utterances] to [...]."""
    numbers = {form: at for at, form in enumerate(dict.fromkeys(forms))}
    at = torch.tensor([numbers[form] for form in forms])
    shares = 1 / torch.bincount(at)[at]
    return (values * shares).sum(-1) / len(numbers)
