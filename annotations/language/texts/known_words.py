"""Which words are English, and which English word a misspelt one may be."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache

from spellchecker import SpellChecker

from annotations.language.texts.word_folding import folded_words

COMMON = 100  # times that pyspellchecker's list, made of subtitles, counts a word that is not rare
_LONGEST_MENDED = 20  # letters of a word for which corrections are looked for


class KnownWords:
    """English words, by the frequency list of pyspellchecker, and the words of ``texts``: a world's own."""

    def __init__(self, texts: Iterable[str] = ()) -> None:
        self._own = {word for text in texts for word in folded_words(text)}

    def __contains__(self, word: str) -> bool:
        """Return whether a folded word is known. Letters of contractions ("don't") are."""
        return len(word) == 1 or word in self._own or word in _CONTRACTED or word in _english()

    def mended(self, word: str) -> str | None:
        """Return the most frequent known word that is one edit from ``word``; a world's own first.

        None where ``word`` is known, where it is too long, and where nothing is as close.
        """
        if word in self or len(word) > _LONGEST_MENDED:
            return None
        close = set(_english().edit_distance_1(word))
        if own := sorted(close & self._own):
            return own[0]
        known = sorted(_english().known(close))
        return max(known, key=_english().word_usage_frequency, default=None)


def is_common(word: str) -> bool:
    """Return whether a folded word is English and no rare one: a misspelt word is often the same as such."""
    return len(word) == 1 or word in _CONTRACTED or _english().word_frequency[word] >= COMMON


# What an apostrophe leaves of a word.
_CONTRACTED = frozenset(
    ("ll", "re", "ve", "don", "doesn", "isn", "couldn", "wouldn", "won", "didn")
)


@cache
def _english() -> SpellChecker:
    """Return the English word list. It takes 0.1 s to load, so that it is loaded when it is first asked."""
    return SpellChecker(language="en", distance=1)
