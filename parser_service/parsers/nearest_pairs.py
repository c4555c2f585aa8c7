"""How many words utterances share: the measure of the nearest neighbour."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable

import numpy as np

from parser_service.parsers.words import words


class WordOverlap:
    """Compares an utterance with many others at once, by an inverted index of their words."""

    def __init__(self, utterances: Iterable[str]):
        postings: dict[str, list[int]] = defaultdict(list)
        sizes = []
        for position, utterance in enumerate(utterances):
            vocabulary = set(words(utterance))
            sizes.append(len(vocabulary))
            for word in vocabulary:
                postings[word].append(position)
        self._postings = {word: np.array(places) for word, places in postings.items()}
        self._sizes = np.array(sizes, dtype=np.int64)  # [utterances]

    def with_all(self, utterance: str) -> np.ndarray:
        """Return the share of common words, 1 − the Jaccard distance between the sets of words.

        Shape [utterances], in their order; equal ratios are equal floats.
        """
        vocabulary = set(words(utterance))
        postings = [self._postings[word] for word in vocabulary if word in self._postings]
        positions = np.concatenate(postings) if postings else np.array([], dtype=np.int64)
        shared = np.bincount(positions, minlength=len(self._sizes))  # [utterances]
        union = self._sizes + len(vocabulary) - shared  # [utterances]
        return np.asarray(shared / np.maximum(union, 1))
