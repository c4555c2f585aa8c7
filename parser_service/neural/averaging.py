"""The moving average of weights along a training, which serves better than the last weights."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager

import torch
from torch import Tensor, nn


class Average:
    """An exponential moving average of trained weights, pulled back to where they started.

    The decay grows with the steps, min(``decay``, (1 + k) / (10 + k)), so that the weights of the
    beginning are soon forgotten. In force is the point between the first weights and the average
    that lies ``kept`` of the way back: fine-tuned weights do better on what the training pairs do
    not show when they stay near the pretrained ones (Wortsman et al. 2022).
    """

    def __init__(
        self,
        weights: Iterable[tuple[str, nn.Parameter]],
        decay: float,
        kept: Mapping[str, float] | None = None,
    ):
        """``kept`` gives the share by name; a weight without one goes all the way."""
        self._weights = dict(weights)
        self.values = {name: weight.detach().clone() for name, weight in self._weights.items()}
        self.live: dict[str, Tensor] = {}  # the weights that training goes on from, while in force
        self.decay = decay
        self._kept = {name: share for name, share in (kept or {}).items() if share}
        self._first = {name: self.values[name].clone() for name in self._kept}

    @torch.no_grad()
    def update(self, step: int) -> None:
        """Takes in the weights after step ``step``, which counts from 1."""
        decay = min(self.decay, (1 + step) / (10 + step))
        held = list(self.values.values())
        live = [weight.detach() for weight in self._weights.values()]
        torch._foreach_lerp_(held, live, 1 - decay)

    @contextmanager
    def in_force(self) -> Iterator[None]:
        """Lets the model have the averaged weights inside the block."""
        self.live = {name: weight.detach().clone() for name, weight in self._weights.items()}
        self._give(self._settled())
        try:
            yield
        finally:
            self._give(self.live)
            self.live = {}

    def keep(self) -> None:
        """Gives the model the averaged weights for good."""
        self._give(self._settled())

    def _settled(self) -> dict[str, Tensor]:
        """The averaged weights, as far back towards the first ones as is asked for."""
        pulled = {
            name: torch.lerp(self.values[name], self._first[name], share)
            for name, share in self._kept.items()
        }
        return {**self.values, **pulled}

    @torch.no_grad()
    def _give(self, values: dict[str, Tensor]) -> None:
        for name, weight in self._weights.items():
            weight.copy_(values[name])
