"""What was heard otherwise than it was said: an utterance compared with the words that were understood.

Whatever reads an utterance says which words it reads in which characters, and why it knows. The changes come from
comparing both, so a reader cannot forget one. Case, accents, ligatures and signs are ways to write, no changes.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher

from annotations.language.texts import places_of

# A word with the apostrophes inside it, a class token, or a sign.
_TOKEN = re.compile(r"<\w+>|\w+(?:['’]\w+)*|[^\w\s]")
_SIGNS_INSIDE = re.compile(r"[^\w]|_")
_COMMA = re.compile(" ?,?")
_LEFT_OVER = re.compile(r" ?([,;:])(?: ?[,;:])*+")
_INDEFINITE = frozenset(("a", "an"))


@dataclass(frozen=True, slots=True)
class HeardChange:
    """What was heard otherwise than it was said, in ``utterance[start:end]``, which is ``said``.

    ``heard`` is empty for what was passed over, ``said`` for what was left out. ``kind`` is one of "filler",
    "repeated", "repair", "courtesy", "contraction", "article", "joined", "split", "number", "sound", "spelling",
    "inflection", "alias" and "reference".
    """

    kind: str
    start: int
    end: int
    said: str
    heard: str


@dataclass(frozen=True, slots=True)
class ReadWords:
    """What an utterance has up to the character ``end``, from where the words before it end, was read as ``words``.

    ``reasons`` are changes inside them whose kinds are known.
    """

    end: int
    words: str
    reasons: tuple[HeardChange, ...] = ()


def fold(word: str) -> str:
    """Return a word without its case, accents, and signs such as apostrophes and hyphens; a lone sign stays.

    Full-width letters and ligatures are the letters that they stand for.
    """
    parts = unicodedata.normalize("NFKD", word.casefold())
    letters = "".join(each for each in parts if not unicodedata.combining(each))
    return _SIGNS_INSIDE.sub("", letters) or word


def tokens_of(text: str) -> list[tuple[int, int]]:
    """Return where the words, class tokens and signs of a text begin and end."""
    return places_of(_TOKEN, text)


def spoken_words(text: str) -> list[str]:
    """Return the words of a name, without signs between them."""
    tokens = (text[start:end] for start, end in tokens_of(text))
    return [token for token in tokens if token[0].isalnum()]


def changes_between(utterance: str, read: Iterable[ReadWords]) -> tuple[HeardChange, ...]:
    """Return what was heard otherwise, in order; no two changes share a character.

    Args:
        utterance: what was said.
        read: what was understood, in order, from its first word to its end.
    """
    tokens = [(start, end) for start, end in tokens_of(utterance) if utterance[start].isalnum()]
    inside = {place for start, end in tokens for place in range(start + 1, end)}
    changes: list[HeardChange] = []
    group: list[ReadWords] = []
    following = 0
    for each in read:
        group.append(each)
        if each.end in inside:  # a word that was taken for two
            continue
        first = following
        while following < len(tokens) and tokens[following][0] < each.end:
            following += 1
        changes += _changes_in(utterance, tokens[first:following], group)
        group = []
    return tuple(changes)


def applied(utterance: str, changes: Sequence[HeardChange]) -> str:
    """Return an utterance with changes made that are in its order; signs that are left over go."""
    pieces, end = [], 0
    for change in changes:
        before, after = utterance[end : change.start], change.end
        # The commas around a filler go with it.
        if change.kind == "filler" and before.rstrip().endswith(","):
            before, after = before.rstrip(" ,") + " ", change.end
            after += len(_COMMA.match(utterance, change.end)[0])  # type: ignore[index]
        pieces += [before, change.heard if change.said else f" {change.heard} "]
        end = after
    text = " ".join("".join((*pieces, utterance[end:])).split())
    return _LEFT_OVER.sub(r"\1", text).lstrip(" ,;:.!?-")


@dataclass(frozen=True, slots=True)
class _Piece:
    """A word that was said, or a change whose kind is known, with the folded words that it leads to."""

    start: int
    end: int
    words: tuple[str, ...]
    change: HeardChange | None = None


def _changes_in(
    utterance: str, tokens: Sequence[tuple[int, int]], read: Sequence[ReadWords]
) -> list[HeardChange]:
    """Return the changes of a few words that were read together, those too that no reason explains."""
    heard = [word for each in read for word in spoken_words(each.words)]
    pieces = _pieces(utterance, tokens, [each for one in read for each in one.reasons])
    owners = [piece for piece in pieces for _ in piece.words]
    reached = [word for piece in pieces for word in piece.words]
    changes = [piece.change for piece in pieces if piece.change]
    size, goal = len(reached), len(heard)
    # From the end: of words that are said twice the last ones are heard.
    matcher = SequenceMatcher(None, reached[::-1], [fold(word) for word in heard][::-1], False)
    for tag, before, after, first, last in matcher.get_opcodes():
        if tag == "equal":
            continue
        touched = owners[size - after : size - before]
        words = heard[goal - last : goal - first]
        if any(piece.change for piece in touched):  # the reasons tell only half
            touched, words, changes = pieces, heard, []
        following = owners[size - before].start if before else read[-1].end
        start = touched[0].start if touched else following
        end = touched[-1].end if touched else following
        said = utterance[start:end]
        changes.append(HeardChange(_kind(said, words), start, end, said, " ".join(words)))
        if touched is pieces:
            break
    return sorted(changes, key=lambda each: (each.start, each.end))


def _pieces(
    utterance: str, tokens: Sequence[tuple[int, int]], reasons: Iterable[HeardChange]
) -> list[_Piece]:
    """Return the words in their order, with changes in place of those that a reason explains.

    Of reasons for the same words the widest counts; one for a part of a word tells nothing of the whole.
    """
    pieces: list[_Piece] = []
    for each in sorted(reasons, key=lambda each: each.start - each.end):
        is_whole = not any(
            start < place < end for place in (each.start, each.end) for start, end in tokens
        )
        is_new = all(each.end <= other.start or other.end <= each.start for other in pieces)
        if is_whole and is_new:
            words = tuple(fold(word) for word in spoken_words(each.heard))
            pieces.append(_Piece(each.start, each.end, words, each))
    for start, end in tokens:
        if all(end <= other.start or other.end <= start for other in pieces):
            pieces.append(_Piece(start, end, (fold(utterance[start:end]),)))
    return sorted(pieces, key=lambda each: (each.start, each.end))


def _kind(said: str, heard: Sequence[str]) -> str:
    """Return the kind of a change that no reason explains."""
    words = [fold(word) for word in spoken_words(said)]
    others = [fold(word) for word in heard]
    if not heard:
        return "courtesy"
    if _INDEFINITE.issuperset((*words, *others)):
        return "article"
    if "".join(words) == "".join(others):
        return "joined" if len(words) > len(others) else "split"
    return "reference"
