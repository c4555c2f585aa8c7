"""From the scores of known and of new forms to one list of calibrated probabilities."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import torch
from torch import Tensor
from torch.nn.functional import logsigmoid

TEMPERATURES = tuple(0.05 * step for step in range(10, 41))  # 0.5 to 2
OFFSETS = tuple(0.25 * step for step in range(-32, 33))  # nats
SLOPES = (0.0, 0.125, 0.25, 0.5, 1.0)


@dataclass(frozen=True, slots=True)
class Scores:
    """What a model says to some utterances, higher for better.

    ``known`` [utterances, known forms] and ``new`` [utterances, new forms] are unnormalised
    log-probabilities. ``evidence`` [utterances] says by how much the glosses of the new forms fit
    better than those of the known ones.
    """

    known: Tensor
    new: Tensor
    evidence: Tensor


@dataclass(frozen=True, slots=True)
class Decision:
    """Temperatures of both lists, and when a form is taken for a new one.

    The log-odds that it is new are ``novelty`` + ``slope`` · evidence.
    """

    novelty: float = 0.0
    slope: float = 1.0
    known_temperature: float = 1.0
    new_temperature: float = 1.0

    def log_probabilities(self, scores: Scores) -> Tensor:
        """Shape [utterances, known + new forms]; each row sums to 1 as probabilities."""
        known = torch.log_softmax(scores.known / self.known_temperature, -1)
        if not scores.new.shape[1]:
            return known
        new = torch.log_softmax(scores.new / self.new_temperature, -1)
        odds = (self.novelty + self.slope * scores.evidence)[:, None]
        return torch.cat([known + logsigmoid(-odds), new + logsigmoid(odds)], -1)


def calibrated(scores: Scores, targets: Tensor) -> Decision:
    """The decision under which the forms [utterances] that were meant are most probable.

    ``targets`` number known forms first, then new ones; -1 for a form that is in neither list,
    which is a new one all the same. Where all forms were known, or all new, evidence has shown
    nothing and counts nothing: validation pairs parted by command ask for a closed set, those
    parted by form for an open one.
    """
    number = scores.known.shape[1]
    is_known = (targets >= 0) & (targets < number)
    is_made = targets >= number
    novelty, slope = best_gate(scores.evidence, ~is_known)
    return Decision(
        novelty,
        slope,
        best_temperature(scores.known[is_known], targets[is_known]),
        best_temperature(scores.new[is_made], targets[is_made] - number),
    )


def best_gate(evidence: Tensor, is_new: Tensor) -> tuple[float, float]:
    """Novelty and slope at which it is most probable which forms [utterances] were new.

    A known and a new form at the mean of the evidence are counted in, half each, so that nothing
    becomes certain.
    """
    if not len(evidence):
        return 0.0, 1.0
    usual = evidence.mean()

    def surprise(gate: tuple[float, float]) -> float:
        offset, slope = gate
        odds = offset + slope * (evidence - usual)
        seen = logsigmoid(torch.where(is_new, odds, -odds)).sum()
        counted_in = logsigmoid(torch.tensor([offset, -offset])).sum() / 2
        return -float(seen + counted_in)

    offset, slope = min(product(OFFSETS, SLOPES), key=surprise)
    return offset - slope * float(usual), slope


def best_temperature(scores: Tensor, targets: Tensor) -> float:
    """The temperature at which ``targets`` are most probable; 1 where there is nothing to see."""
    if not len(targets):
        return 1.0

    def surprise(temperature: float) -> float:
        logs = torch.log_softmax(scores / temperature, -1)
        return -float(logs.gather(1, targets[:, None]).mean())

    return min(TEMPERATURES, key=surprise)
