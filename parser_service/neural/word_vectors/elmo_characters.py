"""Words as ELMo reads them: the bytes of their UTF-8 between markers, padded to one length."""

from __future__ import annotations

from collections.abc import Sequence

# Numbers 0 to 255 are bytes.
SENTENCE_BEGIN, SENTENCE_END, WORD_BEGIN, WORD_END, PADDING = range(256, 261)
CHARACTERS = 261  # rows of the published table; files that also count a mask say one more


def spell(sentence: Sequence[str], longest: int) -> list[list[int]]:
    """Return the characters of each word of ``sentence``, whose begin and end are words of their own.

    Shape [words + 2, longest]; a word is cut where it is longer with its two markers.
    """
    words = [list(word.encode("utf-8")) for word in sentence]
    whole = [[SENTENCE_BEGIN], *words, [SENTENCE_END]]
    return [_pad(word[: longest - 2], longest) for word in whole]


def _pad(characters: list[int], longest: int) -> list[int]:
    marked = [WORD_BEGIN, *characters, WORD_END]
    return marked + [PADDING] * (longest - len(marked))
