"""Dropout that draws its numbers once for a whole text."""

from __future__ import annotations

from torch import Tensor, nn


class SharedDropout(nn.Dropout):
    """Drops the same features of every word of a text (Gal and Ghahramani 2016).

    To draw a number for each word and feature, as usual, takes a CPU a sixth of a training step.
    """

    def forward(self, values: Tensor) -> Tensor:
        """Shape [texts, ..., features], kept."""
        if not self.training or not self.p:
            return values
        kept = values.new_empty(len(values), *[1] * (values.dim() - 2), values.shape[-1])
        return values * (kept.bernoulli_(1 - self.p) / (1 - self.p))


def share_dropout(network: nn.Module) -> None:
    """Gives every dropout layer of ``network`` this kind, at its own rate."""
    for module in [*network.modules()]:
        for name, layer in module.named_children():
            if type(layer) is nn.Dropout:
                setattr(module, name, SharedDropout(layer.p))
