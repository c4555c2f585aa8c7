"""How ELMo spells words: the bytes of their UTF-8, between markers, to one length."""

from __future__ import annotations

from collections.abc import Sequence

# Numbers 0 to 255 are bytes.
SENTENCE_BEGIN, SENTENCE_END, WORD_BEGIN, WORD_END, PADDING = range(256, 261)
CHARACTERS = 261  # rows of the published table; files that count a mask as well say one more


def spell(sentence: Sequence[str], longest: int) -> list[list[int]]:
    """Characters of each word of ``sentence`` with its begin and its end as words of their own.

    Shape [words + 2, longest]; a word is cut where it and its two markers are longer.
    """
    words = [list(word.encode("utf-8")) for word in sentence]
    whole = [[SENTENCE_BEGIN], *words, [SENTENCE_END]]
    return [_padded(word[: longest - 2], longest) for word in whole]


def _padded(characters: list[int], longest: int) -> list[int]:
    marked = [WORD_BEGIN, *characters, WORD_END]
    return marked + [PADDING] * (longest - len(marked))
