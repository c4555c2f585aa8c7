"""Find the utterances of a corpus that are one word apart.

Two utterances differ in one word exactly if they are equal without it, so that each utterance is filed
under what is left when one of its words is deleted (deletion neighbourhoods: Mor and Fraenkel, A hash code
method for detecting and correcting spelling errors, Communications of the ACM 25, 1982). The cost grows
with the number of words of the corpus and not with the number of pairs of utterances.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from parser_service.analysis.arrays import Bools, Ints
from parser_service.analysis.labels import encode

MOST_NEIGHBOURS = 8
_WORD = re.compile(r"<\w+>|[\w'’]+")
_Hashes = NDArray[np.uint64]


def words_of(text: str) -> tuple[str, ...]:
    """Return the lower-cased words of a text without its punctuation; a class token is a word."""
    return tuple(_WORD.findall(text.lower()))


@dataclass(frozen=True, eq=False, slots=True)
class OneEditPairs:
    """Pair k: utterance ``second[k]`` has another word at ``position[k]`` (from 0) than utterance ``first[k]``,
    or, where ``is_addition[k]``, one word more there. ``words`` are those of each utterance."""

    first: Ints  # [pairs]
    second: Ints
    position: Ints
    is_addition: Bools
    words: tuple[tuple[str, ...], ...]

    def __len__(self) -> int:
        return len(self.first)

    def changed_words(self, pair: int) -> tuple[str, str]:
        """Return the word of the first utterance, empty where none, and that of the second."""
        place = int(self.position[pair])
        old = "" if self.is_addition[pair] else self.words[int(self.first[pair])][place]
        return old, self.words[int(self.second[pair])][place]


def mine_pairs(utterances: Sequence[str], most_neighbours: int = MOST_NEIGHBOURS) -> OneEditPairs:
    """Return the pairs of utterances that are one word apart, in ascending order.

    Args:
        utterances: texts; case and punctuation do not count, and of equal ones only the first does.
        most_neighbours: of the utterances that share all but one word, each is paired with so many that
            follow it, so that a frequent pattern does not give a pair for each two of its utterances.
    """
    words = tuple(map(words_of, utterances))
    distinct = {row: number for number, row in reversed(list(enumerate(words))) if row}
    numbers = np.sort(np.fromiter(distinct.values(), dtype=np.int64, count=len(distinct)))
    hashed = _hash([words[number] for number in numbers.tolist()])
    first, second, position = _exchanged(hashed, most_neighbours)
    shorter, longer, added_at = _added(hashed)
    one, other = numbers[np.append(first, shorter)], numbers[np.append(second, longer)]
    places = np.append(position, added_at)
    is_addition = np.repeat([False, True], [len(first), len(shorter)])
    order = np.lexsort((other, one))
    return OneEditPairs(one[order], other[order], places[order], is_addition[order], words)


@dataclass(frozen=True, eq=False, slots=True)
class _Deletions:
    """For each word of a corpus: its row, its place, and two hashes of the row without it; and of whole rows.

    Two independent hashes of 64 bits make a chance agreement out of the question.
    """

    rows: Ints  # [words]
    places: Ints
    without: tuple[_Hashes, _Hashes]  # [words] each
    whole: tuple[_Hashes, _Hashes]  # [rows] each


def _hash(rows: Sequence[tuple[str, ...]]) -> _Deletions:
    lengths = np.fromiter(map(len, rows), dtype=np.int64, count=len(rows))
    codes = encode([word for row in rows for word in row]).codes
    starts = np.cumsum(lengths) - lengths
    places = np.arange(len(codes)) - np.repeat(starts, lengths)
    random = np.random.default_rng(1982)
    hashes = [_polynomials(codes, starts, lengths, places, random) for _ in range(2)]
    (without, whole), (without_again, whole_again) = hashes
    return _Deletions(
        rows=np.repeat(np.arange(len(rows)), lengths),
        places=places,
        without=(without, without_again),
        whole=(whole, whole_again),
    )


def _polynomials(
    codes: Ints, starts: Ints, lengths: Ints, places: Ints, random: np.random.Generator
) -> tuple[_Hashes, _Hashes]:
    """Hash each row without each of its words, and each row: Σ value(word) · base^place modulo 2⁶⁴."""
    size = int(codes.max(initial=0)) + 1
    values: _Hashes = random.integers(2**64 - 1, size=size, dtype=np.uint64)
    base = int(random.integers(2**62, 2**63, dtype=np.uint64)) * 2 + 1  # odd, so it has an inverse
    repeated = np.full(int(lengths.max(initial=1)), base % 2**64, dtype=np.uint64)
    powers: _Hashes = np.cumprod(repeated, dtype=np.uint64)
    terms: _Hashes = values[codes] * powers[places]
    sums: _Hashes = np.concatenate(([np.uint64(0)], np.cumsum(terms, dtype=np.uint64)))
    whole: _Hashes = sums[starts + lengths] - sums[starts]
    before = sums[:-1] - np.repeat(sums[starts], lengths)
    after = np.repeat(whole, lengths) - before - terms
    without: _Hashes = before + after * np.uint64(pow(base, -1, 2**64))
    return without, whole


def _exchanged(hashed: _Deletions, most: int) -> tuple[Ints, Ints, Ints]:
    """Return the pairs of rows that are equal without the word at a place, and the place."""
    mixed = hashed.places.astype(np.uint64) * np.uint64(0x9E3779B97F4A7C15)
    keys = hashed.without[0] + mixed
    order = np.argsort(keys, kind="stable")
    keys, checks = keys[order], (hashed.without[1] - mixed)[order]
    rows, places = hashed.rows[order], hashed.places[order]
    found = []
    for shift in range(1, most + 1):
        is_equal = (keys[:-shift] == keys[shift:]) & (checks[:-shift] == checks[shift:])
        at = np.flatnonzero(is_equal)
        if not len(at):
            break
        found.append((rows[at], rows[at + shift], places[at]))
    if not found:
        return _nothing(), _nothing(), _nothing()
    first, second, position = (np.concatenate(column) for column in zip(*found, strict=True))
    return first, second, position


def _added(hashed: _Deletions) -> tuple[Ints, Ints, Ints]:
    """Return the pairs of rows of which the second without the word at a place is the first, and the place."""
    order = np.argsort(hashed.whole[0])
    if not len(order):
        return _nothing(), _nothing(), _nothing()
    near = np.searchsorted(hashed.whole[0][order], hashed.without[0])
    rows = order[np.minimum(near, len(order) - 1)]
    is_equal = (hashed.whole[0][rows] == hashed.without[0]) & (
        hashed.whole[1][rows] == hashed.without[1]
    )
    at = np.flatnonzero(is_equal)
    shorter, longer, places = rows[at], hashed.rows[at], hashed.places[at]
    # A word that stands twice in a row may be deleted at either place.
    _, first = np.unique(shorter * len(order) + longer, return_index=True)
    return shorter[first], longer[first], places[first]


def _nothing() -> Ints:
    return np.zeros(0, dtype=np.int64)
