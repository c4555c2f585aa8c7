"""A linear layer that answers from weights in half precision, where its weights are such numbers."""

from __future__ import annotations

from typing import Any

import torch
from torch import Tensor, nn

# Rows up to which a product takes longer to read its weights than to multiply them.
FEW = 128


class Linear(nn.Linear):
    """Has uninitialised memory for weights: they are always loaded, and drawing them first would take
    longer than reading them.

    ``pack`` keeps a second copy of the weights, of 16 bits each, which products of few rows read: half
    the bytes take a CPU little more than half the time. The numbers are the same, so that results
    differ in rounding alone.
    """

    _packed: Any = None

    def reset_parameters(self) -> None:
        pass

    def pack(self) -> None:
        """Get ready to answer: the weights do not change any more. Nothing happens where they are no
        numbers in half precision, or where torch has no such product for the processor."""
        weight = self.weight.detach()
        can_multiply = "fbgemm" in torch.backends.quantized.supported_engines
        if weight.device.type == "cpu" and can_multiply and torch.equal(rounded(weight), weight):
            self._packed = torch.ops.quantized.linear_prepack_fp16(weight, self.bias)

    def forward(self, rows: Tensor) -> Tensor:
        """Return the product with the weights, and the bias added. Shape [..., in] to [..., out]."""
        is_few = rows.numel() <= FEW * self.in_features and rows.dtype == torch.float32
        if self._packed is None or not is_few or torch.is_grad_enabled():
            return super().forward(rows)
        product: Tensor = torch.ops.quantized.linear_dynamic_fp16.default(rows, self._packed)
        return product


def pack(network: nn.Module) -> None:
    """``Linear.pack`` every layer of a network."""
    for layer in network.modules():
        if isinstance(layer, Linear):
            layer.pack()


def rounded(weights: Tensor) -> Tensor:
    """Return the nearest numbers in half precision (IEEE 754 binary16), in single precision."""
    return weights.half().float()
