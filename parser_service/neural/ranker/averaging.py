"""The moving average of the weights during a training; it generalises better than the last weights."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager

import torch
from torch import Tensor, nn

from parser_service.neural.sentence_encoder.half_precision import rounded


class Average:
    """An exponential moving average of the trained weights, interpolated with the first weights.

    The decay grows with the steps, min(``decay``, (1 + k) / (10 + k)), so that the first weights are
    soon forgotten. The weights used are on the line from the average to the first weights, the share
    ``kept`` of the way: fine-tuned weights do better on what the training pairs do not show when they
    stay near the pretrained ones (Wortsman et al. 2022). Matrices are rounded to half precision, from
    which single utterances are answered faster (``half_precision``).
    """

    def __init__(
        self,
        weights: Iterable[tuple[str, nn.Parameter]],
        decay: float,
        kept: Mapping[str, float] | None = None,
    ):
        """``kept`` gives the share by name; 0 for a weight that it does not name."""
        self._weights = dict(weights)
        self.values = {name: weight.detach().clone() for name, weight in self._weights.items()}
        self.live: dict[
            str, Tensor
        ] = {}  # the weights that training continues from, while the average is in force
        self.decay = decay
        self._kept = {name: share for name, share in (kept or {}).items() if share}
        self._first = {name: self.values[name].clone() for name in self._kept}

    @torch.no_grad()
    def update(self, step: int) -> None:
        """Add the weights after step ``step``, which counts from 1."""
        decay = min(self.decay, (1 + step) / (10 + step))
        held = list(self.values.values())
        live = [weight.detach() for weight in self._weights.values()]
        torch._foreach_lerp_(held, live, 1 - decay)

    @contextmanager
    def in_force(self) -> Iterator[None]:
        """Give the model the averaged weights inside the block."""
        self.live = {name: weight.detach().clone() for name, weight in self._weights.items()}
        self._set(self._interpolate())
        try:
            yield
        finally:
            self._set(self.live)
            self.live = {}

    def keep(self) -> None:
        """Give the model the averaged weights for good."""
        self._set(self._interpolate())

    def _interpolate(self) -> dict[str, Tensor]:
        """Return the averaged weights, moved towards the first ones by their shares, and rounded."""
        pulled = {
            name: torch.lerp(self.values[name], self._first[name], share)
            for name, share in self._kept.items()
        }
        weights = {**self.values, **pulled}
        return {
            name: rounded(value) if value.dim() > 1 else value for name, value in weights.items()
        }

    @torch.no_grad()
    def _set(self, values: dict[str, Tensor]) -> None:
        for name, weight in self._weights.items():
            weight.copy_(values[name])
