"""Products with weights that are numbers of 16 bits, for the few rows of a single utterance."""

from __future__ import annotations

from typing import Any

import torch
from torch import Tensor, nn

# Rows up to which a product takes longer to read its weights than to multiply them.
FEW = 128


class Linear(nn.Linear):
    """Has uninitialised memory for weights: they are always loaded, and drawing them first would take
    longer than reading them.

    Once it is packed, few rows are multiplied with a second copy of the weights, of 16 bits each: half
    the bytes take a CPU little more than half the time. The numbers are the same, so that results
    differ in rounding alone.
    """

    _packed: Any = None

    def reset_parameters(self) -> None:
        pass

    def pack(self) -> None:
        """Get ready to answer: the weights do not change any more."""
        self._packed = packed(self.weight, self.bias)

    def forward(self, rows: Tensor) -> Tensor:
        """Return the product with the weights, and the bias added. Shape [..., in] to [..., out]."""
        if self._packed is not None and are_few(rows):
            return multiply(rows, self._packed)
        return super().forward(rows)


def packed(weight: Tensor, bias: Tensor) -> Any:
    """Return the weights [out, in] and the bias [out] of a layer for ``multiply``; None where the weights
    are no numbers in half precision, or where torch has no such product for the processor."""
    can_multiply = "fbgemm" in torch.backends.quantized.supported_engines
    if weight.device.type != "cpu" or not can_multiply or not torch.equal(rounded(weight), weight):
        return None
    return torch.ops.quantized.linear_prepack_fp16(weight.detach(), bias.detach())


def are_few(rows: Tensor) -> bool:
    """Return whether ``rows`` [..., in] are better multiplied with packed weights. They never are in
    training: that product has no gradient."""
    is_small = rows.numel() <= FEW * rows.shape[-1] and rows.dtype == torch.float32
    return is_small and not torch.is_grad_enabled()


def multiply(rows: Tensor, weights: Any) -> Tensor:
    """Return ``rows`` times what ``packed`` returned, and the bias added. Shape [..., in] to [..., out]."""
    product: Tensor = torch.ops.quantized.linear_dynamic_fp16.default(rows, weights)
    return product


def rounded(weights: Tensor) -> Tensor:
    """Return the nearest numbers in half precision (IEEE 754 binary16), in single precision."""
    return weights.half().float()
