"""Which name of a world a misspelt one surely is."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable

from rapidfuzz.distance import OSA

from annotations.language.texts import KnownWords

# A misspelt name differs by one edit, or by two where it is long. Every other name is clearly further away.
LETTERS_AN_EDIT = 4
MOST_EDITS = 2
CLEARLY = 2
MOST_WORDS = 3  # of a name that is looked for in an utterance
MOST_COMPARED = 200  # spans of an utterance
_BETWEEN_WORDS = re.compile(r"[\s_-]+")
_WORD = re.compile(r"[^\W_]+")


class MisspeltNames:
    """Mends names where it is sure what is meant."""

    def __init__(self) -> None:
        self._english = KnownWords()

    def meant(self, name: str, names: Iterable[str]) -> str | None:
        """Return the one of ``names`` that ``name`` is, or surely misspells; None where it is not sure.

        What is an English word is no misspelt other one: "make" is not "take".
        """
        folded = _fold(name)
        near = sorted((OSA.distance(folded, _fold(each)), each) for each in names)
        if not near:
            return None
        edits, nearest = near[0]
        most = min(MOST_EDITS, len(folded) // LETTERS_AN_EDIT)
        is_clear = len(near) == 1 or near[1][0] >= edits + CLEARLY
        is_word = all(word in self._english for word in folded.split())
        return nearest if not edits or (edits <= most and is_clear and not is_word) else None

    def find(self, utterance: str, names: Collection[str]) -> str | None:
        """Return the one of ``names`` that an utterance misspells; None where it is none or more than one, and
        where too many of its words are no English."""
        words = _WORD.findall(utterance)
        # An English word alone is none, so that few words are compared.
        unknown = {at for at, word in enumerate(words) if word.casefold() not in self._english}
        spans = {
            " ".join(words[first:last])
            for first in range(len(words))
            for last in range(first + 1, min(len(words), first + MOST_WORDS) + 1)
            if not unknown.isdisjoint(range(first, last))
        }
        if len(spans) > MOST_COMPARED:
            return None
        found = {meant for span in spans if (meant := self.meant(span, names)) is not None}
        return found.pop() if len(found) == 1 else None


def _fold(name: str) -> str:
    return _BETWEEN_WORDS.sub(" ", name).strip().casefold()
