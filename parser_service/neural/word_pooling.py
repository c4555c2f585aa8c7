"""Vectors of subwords as vectors of words."""

from __future__ import annotations

from collections.abc import Sequence

import torch
from torch import Tensor


def mean_by_word(subwords: Tensor, words: Sequence[int | None], number: int) -> Tensor:
    """The mean vector of each word's subwords.

    Args:
        subwords: [subwords, width].
        words: which word each subword is of; None for marks that belong to none.
        number: how many words there are.

    Returns:
        [number, width]; zero for a word without subwords, as one of unknown signs or cut off.
    """
    places = [place for place, word in enumerate(words) if word is not None]
    owners = torch.tensor([word for word in words if word is not None], dtype=torch.long)
    sums = subwords.new_zeros(number, subwords.shape[1])
    sums.index_add_(0, owners, subwords[places])
    counts = torch.bincount(owners, minlength=number).clamp(min=1)  # [number]
    return sums / counts[:, None]
