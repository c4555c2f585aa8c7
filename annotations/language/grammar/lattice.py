"""What can be read between the places of an utterance: its words, and the class tokens of entities that it names.

An utterance of n words has the places 0 to n. An arc reads what is between two places as one word of an
anonymized command. The chart walks every path of the lattice (Chappelier, Rajman, Aragüés and Rozenknop,
"Lattice parsing for speech recognition", TALN 1999).
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Self


@dataclass(frozen=True, slots=True)
class Arc:
    """Reads what is between two places as ``word``. Of two paths the one with the lower ``cost`` is preferred.

    ``number`` tells the arcs of one lattice apart that stand for something, such as an entity; -1 for a word.
    ``changes`` are numbers, too: of what the arc reads otherwise than it was said.
    """

    start: int
    end: int
    word: str
    cost: int = 0
    number: int = -1
    changes: tuple[int, ...] = ()


class Lattice:
    """Arcs between the places 0 to ``end``."""

    def __init__(self, arcs: Iterable[Arc], end: int) -> None:
        self.end = end
        self._from: list[defaultdict[str, list[Arc]]] = [defaultdict(list) for _ in range(end + 1)]
        for arc in arcs:
            self._from[arc.start][arc.word].append(arc)
        self._words = [tuple(by_word) for by_word in self._from]

    @classmethod
    def of_words(cls, words: Sequence[str]) -> Self:
        """Return the lattice with one path, the words as they are."""
        arcs = (Arc(place, place + 1, word) for place, word in enumerate(words))
        return cls(arcs, len(words))

    def arcs(self, place: int, word: str) -> Sequence[Arc]:
        """Return the arcs from a place that read ``word``."""
        return self._from[place].get(word, ())

    def words_from(self, place: int) -> Sequence[str]:
        """Return what the arcs from a place read."""
        return self._words[place]

    @cached_property
    def words(self) -> frozenset[str]:
        """What its arcs read."""
        return frozenset(word for words in self._words for word in words)

    @cached_property
    def n_arcs(self) -> int:
        return sum(len(arcs) for words in self._from for arcs in words.values())

    def ends(self, words: Sequence[str], place: int) -> frozenset[int]:
        """Return the places where a path that reads ``words`` from a place can end."""
        reached = {place}
        for word in words:
            reached = {arc.end for each in reached for arc in self._from[each].get(word, ())}
            if not reached:
                break
        return frozenset(reached)
