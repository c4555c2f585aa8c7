"""Number and articles of English nouns: one mechanism prints plurals and knows them again.

``data/inflection.toml`` has the nouns that no rule inflects.
"""

from __future__ import annotations

from collections.abc import Container, Iterator

from annotations.language.texts.stand_ins import STAND_IN, read_stand_in, stand_in
from annotations.language.texts.word_lists import (
    BEGINNINGS_AFTER_A,
    BEGINNINGS_AFTER_AN,
    DETERMINERS,
    LETTERS_AFTER_AN,
    NO_ENDINGS,
    NOUNS_IN_I_OR_U,
    NOUNS_IN_IE,
    NUMBERS,
    PLURALS,
    SINGULARS_IN_S,
    UNCHANGING,
)

_VOWELS = tuple("aeiou")
_SIBILANTS = ("s", "x", "z", "ch", "sh")
_ES = ("ses", "xes", "zes", "ches", "shes", "oes")
_FEWEST_BEFORE = 2  # letters of a noun before the one that it ends with
_LONGEST_ABBREVIATION = 3  # letters: TVs, but TEAS
_PLURALS: dict[str, tuple[str, ...]] = dict.fromkeys((*UNCHANGING, *NOUNS_IN_IE), ()) | PLURALS
_SINGULARS = {form: noun for noun, forms in PLURALS.items() for form in forms}


def plural(noun: str) -> str:
    """Return the plural of a noun phrase to print: ``knives``, ``people``, ``bottles of water``.

    What looks like a plural stays: kinds of things are called ``tools`` and ``drinks`` in an ontology.
    """
    before, head, rest = _split(noun)
    if STAND_IN.fullmatch(head):
        return before + stand_in(read_stand_in(head)[0], is_plural=True) + rest
    return noun if _is_plural(head) else before + next(_plurals(head), head) + rest


def singular(noun: str) -> str:
    """Return the likeliest singular of a noun phrase; what looks like none of a plural stays."""
    before, head, rest = _split(noun)
    return before + next(_singulars(head), head) + rest if _is_plural(head) else noun


def looks_plural(noun: str) -> bool:
    """Return whether a noun phrase looks like a plural: ``chips``, ``people``, but not ``glass``."""
    return _is_plural(_split(noun)[1])


def spellings(noun: str) -> Iterator[str]:
    """Yield what a noun phrase may be called in the plural, and in the singular if it is one; its head changes.

    The plural that is printed is the first one of a singular. Each is known again: a noun is among the spellings of
    its plural. Plurals that people write though they are none are among them, too: ``knifes``.
    """
    before, head, rest = _split(noun)
    for spelling in dict.fromkeys((*_plurals(head), *_singulars(head))):
        if spelling != head:
            yield f"{before}{spelling}{rest}"
    if rest:  # people say "tin of soups", too
        start, _, last = noun.rpartition(" ")
        yield from (
            f"{start} {each}" for each in (*_plurals(last), *_singulars(last)) if each != last
        )


def article(noun: str) -> str:
    """Return ``a`` or ``an``, whichever a noun phrase begins with."""
    begin, first = noun.lower(), noun.partition(" ")[0]
    if begin.startswith(BEGINNINGS_AFTER_AN):
        return "an"
    if begin.startswith(BEGINNINGS_AFTER_A):
        return "a"
    if len(first) <= _LONGEST_ABBREVIATION and first.isupper() and first[1:]:
        return "an" if first.startswith((*LETTERS_AFTER_AN, *"AEIO")) else "a"
    return "an" if begin.startswith(_VOWELS) else "a"


def definite(noun: str) -> str:
    """Return a noun phrase behind ``the``; ``bed two`` and ``shelf 3`` are names, and stay alone, as does what has a
    determiner already."""
    before, _, last = noun.rpartition(" ")
    is_numbered = bool(before) and (last.isdigit() or last.lower() in NUMBERS)
    is_determined = noun.partition(" ")[0].lower() in DETERMINERS
    return noun if is_numbered or is_determined else f"the {noun}"


def say_count(count: int, noun: str) -> str:
    """Return ``0 arguments``, ``1 argument`` or ``2,000 arguments``."""
    return f"{count:,} {noun if count == 1 else plural(noun)}"


def _split(noun: str) -> tuple[str, str, str]:
    """Return what stands before the head of a noun phrase, the head, and what stands after it."""
    first, of, rest = noun.partition(" of ")
    before, space, head = first.rpartition(" ")
    return before + space, head, of + rest


def _lower(word: str) -> str:
    """Return a word in lower case, with as many letters."""
    lower = word.lower()
    return lower if len(lower) == len(word) else word


def _like(word: str, form: str) -> str:
    """Return ``form`` written as ``word`` is."""
    if word.isupper() and len(word) > _LONGEST_ABBREVIATION:
        return form.upper()
    letters = zip(_lower(word), form, strict=False)
    same = next(
        (at for at, (one, other) in enumerate(letters) if one != other), min(len(word), len(form))
    )
    return word[:same] + form[same:]


def _ending(word: str, known: Container[str]) -> str:
    """Return the longest of ``known`` that a word in lower case is, or ends with; empty where there is none."""
    for start in range(len(word)):
        end = word[start:]
        if end in known and (start == 0 or (start >= _FEWEST_BEFORE and end not in NO_ENDINGS)):
            return end
    return ""


def _plurals(word: str) -> Iterator[str]:
    """Yield the plurals of a word, the one to print first; none of what is clearly a plural."""
    lower = _lower(word)
    if _is_plural(word) and (lower.endswith("es") or not lower.endswith("s")):
        return
    noun = _ending(lower, _PLURALS)
    stem = lower.removesuffix(noun)
    for form in (*(stem + each for each in _PLURALS.get(noun, ())), *_regular(lower)):
        yield _like(word, form)


def _regular(lower: str) -> Iterator[str]:
    """Yield the plurals that rules make, the best one first; of a noun that does not change first itself."""
    if _ending(lower, UNCHANGING):
        yield lower
    if lower.endswith("y") and not lower[:-1].endswith(_VOWELS):
        yield f"{lower[:-1]}ies"
    elif lower.endswith(("sis", "xis")):
        yield f"{lower[:-2]}es"
    yield lower + ("es" if lower.endswith(_SIBILANTS) else "s")
    if lower.endswith(("f", "fe")):
        yield f"{lower.removesuffix('e')[:-1]}ves"
    elif lower.endswith("o"):
        yield f"{lower}es"
    elif lower.endswith("man"):
        yield f"{lower[:-2]}en"


def _is_plural(word: str) -> bool:
    lower = _lower(word)
    if _ending(lower, UNCHANGING):
        return False
    if _ending(lower, _SINGULARS):
        return True
    return lower.endswith("s") and not _is_singular_in_s(lower)


def _is_singular_in_s(lower: str) -> bool:
    if lower.endswith(("us", "is")):
        return lower[:-1] not in NOUNS_IN_I_OR_U
    return lower.endswith("ss") or bool(_ending(lower, SINGULARS_IN_S))


def _singulars(word: str) -> Iterator[str]:
    """Yield what a word may be the plural of, the likeliest first."""
    lower = _lower(word)
    form = _ending(lower, _SINGULARS)
    if form:
        yield _like(word, lower.removesuffix(form) + _SINGULARS[form])
    if len(lower) <= _FEWEST_BEFORE or not lower.endswith("s") or lower.endswith("ss"):
        return
    likely = dict.fromkeys(_stems(lower))
    for stem in sorted(likely, key=lambda each: not _is_known(each)):
        yield _like(word, stem)


def _stems(lower: str) -> Iterator[str]:
    """Yield what rules make of a word in s, the likeliest first."""
    if lower.endswith("ies"):
        yield f"{lower[:-3]}y"
    if lower.endswith(("ches", "shes", "sses", "xes", "zes")):
        yield lower[:-2]
    yield lower[:-1]
    if lower.endswith("ves"):
        yield from (f"{lower[:-3]}f", f"{lower[:-3]}fe")
    if lower.endswith(_ES):
        yield lower[:-2]
    if lower.endswith(("ses", "xes")):
        yield f"{lower[:-2]}is"


def _is_known(stem: str) -> bool:
    """Whether a noun is on a list, so that its plural is taken for no other's."""
    if stem.endswith("s"):
        return bool(_ending(stem, SINGULARS_IN_S)) or stem in ("bus", "virus")
    return bool(_ending(stem, PLURALS) or _ending(stem, NOUNS_IN_IE))
