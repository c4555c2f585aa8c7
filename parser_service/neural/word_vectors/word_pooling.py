"""Vectors of words, from vectors of subwords."""

from __future__ import annotations

from collections.abc import Sequence

import torch
from torch import Tensor


def mean_by_word(subwords: Tensor, words: Sequence[int | None], number: int) -> Tensor:
    """Return the mean vector of each word's subwords.

    Args:
        subwords: [subwords, width].
        words: the word that each subword is part of; None for special tokens.
        number: the number of words.

    Returns:
        [number, width]; zero for a word without subwords, such as one that was cut off.
    """
    places = [place for place, word in enumerate(words) if word is not None]
    owners = torch.tensor([word for word in words if word is not None], dtype=torch.long)
    sums = subwords.new_zeros(number, subwords.shape[1])
    sums.index_add_(0, owners, subwords[places])
    counts = torch.bincount(owners, minlength=number).clamp(min=1)  # [number]
    return sums / counts[:, None]
