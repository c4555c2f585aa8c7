"""Which words of a vocabulary a word that was heard or typed may be.

Two errors differ. People and keyboards misspell: the result is hardly ever a word. Recognisers write another word
that sounds alike. So a word that English does not have is compared by its letters (optimal string alignment) and its
sound, an English one by its sound alone. The sound of the consonants is that of Philips, "Hanging on the Metaphone"
(Computer Language 1990); what Metaphone leaves out, the vowels, is compared by kind.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache, lru_cache

from jellyfish import metaphone
from rapidfuzz.distance import OSA
from rapidfuzz.process import extract

from annotations.language.texts.known_words import is_common
from annotations.language.texts.word_lists import (
    AGREEING,
    ALIKE,
    BOUNDARIES,
    DETERMINERS,
    PLACE_PREPOSITIONS,
)

# Edits by letters of a word, and most for one that sounds the same.
LETTERS_AN_EDIT = 4
MOST_EDITS = 3
# What it costs to hear another word. Words that sound the same are equally near, however they are spelt.
SAME_SOUND, SAME_STEM, EDITED, AN_EDIT = 5, 5, 5, 2
OF_A_WORD = 3  # more where what was said is a word itself
LOOSE = 3  # more where only the words beside it make it likely
LONGEST = 24  # letters of a word that is compared
SHORTEST = 3
# Words that tie others together; recognisers seldom put them for a noun or a verb.
_FUNCTION_WORDS = BOUNDARIES | DETERMINERS | PLACE_PREPOSITIONS
_SHORT = 5  # letters; a shorter typo does not change the first letter
_MOST_NEAR = 8  # words that one word may be
_REMEMBERED = 8_192  # words of which a vocabulary remembers what they may be

_VOWELS = re.compile(r"[aeiou][aeiouyw]*|(?<=.)y[aeiouyw]*")
# The sounds that letters stand for; small letters are long vowels. Otherwise the first letter decides.
_SOUNDS_OF = {
    **{
        "a": "A",
        "e": "E",
        "i": "I",
        "o": "O",
        "u": "U",
        "y": "Ii",
        "ea": "IiE",
        "ee": "Ii",
        "ie": "Ii",
    },
    **{
        "ei": "IiAa",
        "ey": "IiAa",
        "ai": "Aa",
        "ay": "Aa",
        "au": "OoAa",
        "aw": "OoAa",
        "ew": "Uu",
        "eu": "Uu",
    },
    **{
        "ui": "UuI",
        "eo": "IiE",
        "oo": "OoUu",
        "ou": "OoUu",
        "ow": "OoUu",
        "oa": "Oo",
        "yi": "Ii",
        "yo": "IiOo",
    },
}
_SILENT, _LONG = re.compile("[aeiouy][^aeiouy]{1,2}e$"), re.compile("[aeiouy][^aeiouy]e$")
_PAST = re.compile("[^aeioutd]ed$")
_VOWEL = re.compile("[aeiouy]")
# Letters of consonants that Metaphone does not tell apart, though speakers do.
_DENTALS = re.compile("t(?!c?h)|d(?!g)")
_PAIRS = ("g", "ckq"), ("v", "fp")


@dataclass(frozen=True, slots=True)
class Near:
    """A word that another one may be. ``kind`` says why: "sound", "spelling" or "inflection".

    ``is_sure`` is false where the words around have to make it likely.
    """

    word: str
    kind: str
    cost: int
    is_sure: bool = True


class NearWords:
    """A vocabulary of folded words, in which near ones are looked for."""

    def __init__(self, words: Iterable[str]) -> None:
        self._words = sorted({word for word in words if len(word) <= LONGEST})
        self._by_sound: defaultdict[str, list[str]] = defaultdict(list)
        self._by_stem: defaultdict[str, list[str]] = defaultdict(list)
        for word in self._words:
            self._by_sound[consonants(word)].append(word)
            for stem in _stems(word):
                self._by_stem[stem].append(word)
        self.near = lru_cache(_REMEMBERED)(self._near)

    def _near(self, said: str) -> tuple[Near, ...]:
        """Return the words that ``said``, a folded word, may be; the nearest first, without itself."""
        alike = [
            Near(word, kind, SAME_SOUND)
            for kind, table in (("sound", _alike()), ("inflection", _agreeing()))
            for word in table.get(said, ())
            if word in self._by_stem
        ]
        if not SHORTEST <= len(said) <= LONGEST or not said.isalpha() or said in _FUNCTION_WORDS:
            return tuple(alike)
        found = {each.word: each for each in alike}
        for stem in _stems(said):
            for word in self._by_stem.get(stem, ()):
                found.setdefault(word, Near(word, "inflection", SAME_STEM))
        for word in self._by_sound.get(consonants(said), ()):
            if len(word) >= SHORTEST and (near := _by_sound(said, word)):
                found.setdefault(word, near)
        most = _most_edits(said)
        close = extract(
            said, self._words, scorer=OSA.distance, score_cutoff=max(most, 1), limit=None
        )
        for word, edits, _ in close:
            if near := _by_letters(said, word, int(edits), most):
                found.setdefault(word, near)
        found.pop(said, None)
        if is_common(said):
            for word in _FUNCTION_WORDS.difference(each.word for each in alike):
                found.pop(word, None)
        nearest = sorted(found.values(), key=lambda each: (each.cost, each.word))
        return tuple(nearest[:_MOST_NEAR])


def _by_sound(said: str, word: str) -> Near | None:
    edits = OSA.distance(said, word)
    if edits > min(MOST_EDITS, max(len(said), len(word)) // 2):
        return None
    more = OF_A_WORD if is_common(said) else 0
    kind = "sound" if more or edits > _most_edits(said) else "spelling"
    if sounds_like(said, word):
        return Near(word, kind, SAME_SOUND + more)
    return Near(word, kind, SAME_SOUND + more + LOOSE, not more)


def _by_letters(said: str, word: str, edits: int, most: int) -> Near | None:
    """Return ``word`` as what was meant by ``said``; None where it is too far."""
    if len(word) < SHORTEST or not edits:
        return None
    cost = EDITED + AN_EDIT * edits
    if len(said) == SHORTEST:
        return Near(word, "spelling", cost) if _is_swapped(said, word) else None
    if edits > most or (said[0] != word[0] and min(len(said), len(word)) <= _SHORT):
        return None
    if is_common(said):
        cost += OF_A_WORD
        if is_common(word):
            return Near(word, "sound", cost + LOOSE, False)
    return Near(word, "spelling", cost)


def _is_swapped(said: str, word: str) -> bool:
    """Whether two letters of a short word that is none changed places: "teh"."""
    return sorted(said) == sorted(word) and not is_common(said)


def _most_edits(said: str) -> int:
    return len(said) // LETTERS_AN_EDIT


@lru_cache(_REMEMBERED)
def consonants(word: str) -> str:
    """Return how the consonants of a folded word sound; a vowel at the beginning is "A"."""
    word = re.sub("^chr", "kr", word.removesuffix("g") if word.endswith("ing") else word)
    key = metaphone(word)
    if word[0] in "aeiou" and key[:1] not in tuple("AEIOU"):
        key = f"A{key}"
    key = key[:1].replace("J", "X") + re.sub("[HWY]", "", key[1:].replace("J", "X"))
    return re.sub(r"(.)\1+", r"\1", re.sub("^[AEIOU]", "A", key))


@lru_cache(_REMEMBERED)
def _vowels(word: str) -> tuple[str, ...]:
    """Return which sounds each group of vowels of a word may have."""
    is_long = bool(_LONG.search(word))
    if word.endswith("ing"):
        word = word[:-1]
    elif _PAST.search(word) and _VOWEL.search(word[:-3]):
        word = word[:-2] + "d"
    elif _SILENT.search(word):
        word = word[:-1]
    groups = _VOWELS.findall(word)
    if is_long and len(groups) == 1 and len(groups[0]) == 1:
        return (_SOUNDS_OF[groups[0]][0].lower(),)
    sounds = [
        _SOUNDS_OF.get(group, _SOUNDS_OF.get(group[:2], _SOUNDS_OF[group[0]])) for group in groups
    ]
    if word.endswith(("ear", "ears")):
        sounds[-1] += "Aa"  # pear, but also near
    return tuple(sounds)


def sounds_like(one: str, other: str) -> bool:
    """Whether two folded words sound the same: the consonants, the number of vowels, the first and a last one."""
    if consonants(one) != consonants(other) or _dentals(one) != _dentals(other):
        return False
    for voiced, voiceless in _PAIRS:
        if {one[0], other[0]} <= {*voiced, *voiceless} and (one[0] in voiced) != (
            other[0] in voiced
        ):
            return False
    first, second = _vowels(one), _vowels(other)
    if len(first) != len(second):
        return False
    if not first:
        return True
    if set(first[0]).isdisjoint(second[0]):
        return False
    return not set(_ending(one)).isdisjoint(_ending(other))


def _dentals(word: str) -> list[str]:
    return _DENTALS.findall(re.sub(r"(.)\1", r"\1", word))


def _ending(word: str) -> str:
    """Return which vowels a word may end with, "-" for a consonant. Daniel is not Danielle."""
    word = re.sub("(?<=[aeiouy])h$", "", word)
    if word.endswith("oe"):
        return "IiOo"
    if word.endswith(("lle", "tte")):
        return "F"
    if word[-1] not in "aeiouy" or (word[-1] == "e" and word[-2] not in "aeiouy"):
        return "-"
    return _SOUNDS_OF.get(word[-2:], _SOUNDS_OF[word[-1]])


def _stems(word: str) -> set[str]:
    """Return what a word may be without the ending of a plural, a past or a gerund."""
    stems = {word}
    if len(word) <= SHORTEST or word.endswith("ss"):
        return stems
    if word.endswith("ies"):
        stems.add(f"{word[:-3]}y")
    for ending in ("s", "es", "d", "ed", "ing"):
        stem = word.removesuffix(ending)
        if stem != word and len(stem) >= SHORTEST:
            stems.add(stem)
            if ending == "ing":
                stems.add(f"{stem}e")
            if ending in ("ed", "ing") and stem[-1] == stem[-2]:
                stems.add(stem[:-1])
    if word.endswith("ing") and len(word) == len("going"):
        stems.add(word[:-3])
    return stems


@cache
def _alike() -> dict[str, tuple[str, ...]]:
    return _by_member(ALIKE)


@cache
def _agreeing() -> dict[str, tuple[str, ...]]:
    return _by_member(AGREEING)


def _by_member(groups: tuple[tuple[str, ...], ...]) -> dict[str, tuple[str, ...]]:
    table: defaultdict[str, dict[str, None]] = defaultdict(dict)
    for group in groups:
        for word in group:
            table[word] |= dict.fromkeys(other for other in group if other != word)
    return {word: tuple(others) for word, others in table.items()}
