"""How many different words texts have, each text given as its words."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Sequence
from math import exp, lgamma


def vocabulary_growth(texts: Sequence[Collection[str]]) -> list[int]:
    """Return how many different words the first text has, the first two, and so on."""
    seen: set[str] = set()
    growth = []
    for words in texts:
        seen.update(words)
        growth.append(len(seen))
    return growth


def expected_vocabulary(texts: Sequence[Collection[str]], sample: int) -> float:
    """Return how many different words ``sample`` of the texts have, on average over all ways to draw them.

    So corpora of different sizes compare (rarefaction: Hurlbert, The nonconcept of species diversity, Ecology
    52, 1971).

    Args:
        sample: from 0 to the number of texts.
    """
    texts_with = Counter(word for words in texts for word in set(words))
    # Words that occur in as many texts are missed as often.
    kinds = Counter(texts_with.values())
    total = len(texts)
    return sum(
        words * (1 - _missed(total, occurring, sample)) for occurring, words in kinds.items()
    )


def _missed(total: int, occurring: int, sample: int) -> float:
    """Return the probability that none of ``occurring`` texts is among ``sample`` of ``total``."""
    without = total - occurring
    if sample > without:
        return 0.0
    return exp(
        lgamma(without + 1)
        - lgamma(without - sample + 1)
        - lgamma(total + 1)
        + lgamma(total - sample + 1)
    )
