"""Words without what people write in different ways."""

from __future__ import annotations

import re
import unicodedata

_WORD = re.compile(r"[^\W_]+")
_POSSESSIVE = re.compile(r"['’]s\b")


def folded_words(text: str) -> list[str]:
    """Return the words of ``text`` without case, accents, punctuation, hyphens and possessive 's."""
    parts = unicodedata.normalize("NFKD", _POSSESSIVE.sub("", text.casefold()))
    return _WORD.findall("".join(each for each in parts if not unicodedata.combining(each)))
