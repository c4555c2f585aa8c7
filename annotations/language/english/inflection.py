"""Plurals of English nouns: the one to print, and likely spellings to recognise words by."""

from __future__ import annotations

from collections.abc import Iterator

from annotations.language.english.stand_ins import STAND_IN, read_stand_in, stand_in
from annotations.language.english.word_lists import PLURALS

_VOWELS = "aeiou"
_SIBILANTS = ("s", "x", "z", "ch", "sh")
# Words that are said with another first sound than their first letter has.
_AFTER_A = ("uni", "use", "usu", "euro", "one ", "ewe")
_AFTER_AN = ("hour", "honest", "honour", "heir")
_SINGULAR_ENDS = (
    "ss",
    "us",
    "is",
    "mos",
)  # of words with an s that is no plural's: glass, bus, iris, thermos


def plural(noun: str) -> str:
    """Return the plural of a noun phrase: ``objects``, ``people``, ``objects of the category``.

    What looks like a plural stays: kinds of things are called ``tools`` and ``drinks`` in an ontology.
    """
    head, of, rest = noun.partition(" of ")
    before, space, last = head.rpartition(" ")
    if STAND_IN.fullmatch(last):
        plural_of_last = stand_in(read_stand_in(last)[0], is_plural=True)
    elif last in PLURALS:
        plural_of_last = PLURALS[last]
    elif looks_plural(last):
        plural_of_last = last
    else:
        plural_of_last = f"{last[:-1]}ies" if _ends_in_consonant_y(last) else _add_s(last)
    return before + space + plural_of_last + of + rest


def looks_plural(noun: str) -> bool:
    """Return whether a noun phrase looks like a plural: ``chips``, but not ``glass``."""
    last = noun.lower().rpartition(" ")[2]
    return last.endswith("s") and not last.endswith(_SINGULAR_ENDS)


def article(noun: str) -> str:
    """Return ``a`` or ``an``, whichever a noun phrase begins with."""
    begin = noun.lower()
    is_vowel = begin.startswith(_AFTER_AN) or (
        begin.startswith(tuple(_VOWELS)) and not begin.startswith(_AFTER_A)
    )
    return "an" if is_vowel else "a"


def say_count(count: int, noun: str) -> str:
    """Return ``0 arguments``, ``1 argument`` or ``2,000 arguments``."""
    return f"{count:,} {noun if count == 1 else plural(noun)}"


def spellings(noun: str) -> Iterator[str]:
    """Yield likely plurals and singulars of a noun phrase; only its last word changes.

    ``knife`` gives knives, ``dish`` dishes, ``cookies`` cookie and cooky, ``tea spoon`` tea spoons.
    """
    head, space, last = noun.rpartition(" ")
    for spelling in (*_plurals(last), *_singulars(last)):
        if spelling and spelling != last:
            yield f"{head}{space}{spelling}"


def _ends_in_consonant_y(word: str) -> bool:
    lower = word.lower()
    return lower.endswith("y") and lower[-2:-1] not in _VOWELS


def _plurals(word: str) -> Iterator[str]:
    lower = word.lower()
    if _ends_in_consonant_y(word):
        yield f"{word[:-1]}ies"
    if lower.endswith("fe"):
        yield f"{word[:-2]}ves"
    elif lower.endswith("f"):
        yield f"{word[:-1]}ves"
    elif lower.endswith("o"):
        yield f"{word}es"
    elif lower.endswith("man"):
        yield f"{word[:-2]}en"
    yield _add_s(word)


def _add_s(word: str) -> str:
    return word + ("es" if word.lower().endswith(_SIBILANTS) else "s")


def _singulars(word: str) -> Iterator[str]:
    lower = word.lower()
    if len(word) < 4 or not lower.endswith("s") or lower.endswith("ss"):
        return
    if lower.endswith("ies"):
        yield f"{word[:-3]}y"
    if lower.endswith("ves"):
        yield from (f"{word[:-3]}f", f"{word[:-3]}fe")
    if lower.endswith(("ses", "xes", "zes", "ches", "shes", "oes")):
        yield word[:-2]
    yield word[:-1]
