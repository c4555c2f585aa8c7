"""Draw a share of the training items, so that what is drawn is as independent as the parts of the split."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from random import Random

from annotations.language.corpus.splitting import Criterion, SplitItem


def draw_share(
    items: Sequence[SplitItem], criterion: Criterion, share: float, seed: int = 0
) -> tuple[bool, ...]:
    """Return for each item whether it belongs to the drawn ``share``, from 0 to 1, of ``items``.

    Items that the criterion keeps together are drawn together, such as all pairs of one logical form:
    half of the pairs then shows half of the forms. The order of the keys depends only on the items and
    the seed, and a share is the shortest beginning of it with at least so many items. So a smaller
    share is part of every larger one. Raises ValueError for a share that is not above 0 and up to 1.
    """
    if not 0 < share <= 1:
        raise ValueError(f"The share {share:g} has to be above 0 and at most 1.")
    counts = Counter(item.key(criterion) for item in items)
    keys = sorted(counts)
    Random(seed).shuffle(keys)
    wanted = math.ceil(share * len(items) - 1e-9)
    drawn: set[str] = set()
    taken = 0
    for key in keys:
        if taken >= wanted:
            break
        drawn.add(key)
        taken += counts[key]
    return tuple(item.key(criterion) in drawn for item in items)
