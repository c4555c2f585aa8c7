"""Words as numbers and back."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

PADDING, UNKNOWN, START, END = range(4)
SPECIAL = ("@padding", "@unknown", "@start", "@end")


class Vocabulary:
    """A fixed list of words. Numbers 0 to 3 are padding, unknown, start and end."""

    def __init__(self, words: Sequence[str]):
        """Number ``words``, which exclude the special ones, in their order."""
        self.words = tuple(words)
        self._texts = SPECIAL + self.words
        self._numbers = {word: number for number, word in enumerate(self._texts)}

    @classmethod
    def of(cls, sentences: Iterable[Sequence[str]], minimum_count: int = 1) -> Vocabulary:
        """Make a vocabulary of the words that occur at least ``minimum_count`` times, in alphabetical order."""
        counts = Counter(word for sentence in sentences for word in sentence)
        return cls(sorted(word for word, count in counts.items() if count >= minimum_count))

    def __len__(self) -> int:
        return len(self._texts)

    def numbers(self, sentence: Sequence[str]) -> list[int]:
        """Return the number of each word, ``UNKNOWN`` where it has none."""
        return [self._numbers.get(word, UNKNOWN) for word in sentence]

    def sentence(self, numbers: Sequence[int]) -> list[str]:
        """Return the words of ``numbers`` up to the first ``END``."""
        cut = list(numbers).index(END) if END in numbers else len(numbers)
        return [self._texts[number] for number in numbers[:cut]]
