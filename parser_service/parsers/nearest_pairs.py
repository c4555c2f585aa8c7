"""Training pairs that are kept, and how many words an utterance shares with each of them."""

from __future__ import annotations

from abc import abstractmethod
from collections import defaultdict
from collections.abc import Iterable
from pathlib import Path
from typing import Self

import numpy as np

from parser_service.parsers.interface import Knowledge, Parser
from parser_service.parsers.storage import open_sealed, read_json, seal, write_json
from parser_service.parsers.words import words

PAIRS = "pairs.json"


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


class PairKeeper(Parser):
    """A parser that consists of its pairs, each an utterance and its form."""

    _pairs: list[tuple[str, str]]

    @abstractmethod
    def keep(self, pairs: list[tuple[str, str]]) -> None:
        """Keep ``pairs`` as ``_pairs``, and what answers are found by."""

    def save(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        write_json(folder / PAIRS, self._pairs)
        seal(folder, self, [PAIRS])

    @classmethod
    def load(cls, folder: Path, knowledge: Knowledge | None = None) -> Self:
        saved = open_sealed(folder, cls, [PAIRS])
        parser = cls(saved.config, saved.seed, knowledge)
        parser.keep([(utterance, form) for utterance, form in read_json(folder / PAIRS)])
        return parser

    def parameters(self) -> int:
        return 0
