"""Find the utterances of a corpus that are one word apart.

Two utterances differ in one word exactly if they are equal without it, so that each utterance is filed
under what is left when one of its words is deleted (deletion neighbourhoods: Mor and Fraenkel, A hash code
method for detecting and correcting spelling errors, Communications of the ACM 25, 1982). The cost grows
with the number of words of the corpus and not with the number of pairs of utterances.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain
from string import punctuation

import numpy as np
from numpy.typing import NDArray

from parser_service.analysis.arrays import Bools, Ints
from parser_service.analysis.encoded_labels import encode

MOST_NEIGHBOURS = 8
_NO_WORDS = "".join(set(punctuation) - set("<>'_")) + "“”„…–—"
_SPACES = str.maketrans(_NO_WORDS, " " * len(_NO_WORDS))
_Hashes = NDArray[np.uint64]


def words_of(text: str) -> tuple[str, ...]:
    """Return the lower-cased words of a text without its punctuation; a class token is a word."""
    return tuple(text.lower().translate(_SPACES).split())


@dataclass(frozen=True, eq=False, slots=True)
class OneEditPairs:
    """Pair k: utterance ``second[k]`` has another word at ``position[k]`` (from 0) than utterance ``first[k]``,
    or, where ``is_addition[k]``, one word more there."""

    utterances: Sequence[str]
    first: Ints  # [pairs]
    second: Ints
    position: Ints
    is_addition: Bools

    def __len__(self) -> int:
        return len(self.first)

    def changed_words(self, pair: int) -> tuple[str, str]:
        """Return the word of the first utterance, empty where none, and that of the second."""
        place = int(self.position[pair])
        new = words_of(self.utterances[int(self.second[pair])])[place]
        if self.is_addition[pair]:
            return "", new
        return words_of(self.utterances[int(self.first[pair])])[place], new


def mine_pairs(utterances: Sequence[str], most_neighbours: int = MOST_NEIGHBOURS) -> OneEditPairs:
    """Return the pairs of utterances that are one word apart, in ascending order.

    Args:
        utterances: texts; case and punctuation do not count, and of equal ones only the first does.
        most_neighbours: of the utterances that share all but one word, each is paired with so many that
            follow it, so that a frequent pattern does not give a pair for each two of its utterances.
    """
    hashed = _hash([words_of(text) for text in utterances])
    first, second, position = _exchanged(hashed, most_neighbours)
    shorter, longer, added_at = _added(hashed)
    one, other = np.append(first, shorter), np.append(second, longer)
    places = np.append(position, added_at)
    is_addition = np.repeat([False, True], [len(first), len(shorter)])
    order = np.lexsort((other, one))
    return OneEditPairs(utterances, one[order], other[order], places[order], is_addition[order])


@dataclass(frozen=True, eq=False, slots=True)
class _Deletions:
    """For each word of the distinct utterances: which utterance, its place, and two hashes of the rest of it.

    ``distinct`` are the first of equal utterances, without empty ones, and ``whole`` two hashes of each.
    Two independent hashes of 64 bits make a chance agreement out of the question.
    """

    rows: Ints  # [words]
    places: Ints
    without: tuple[_Hashes, _Hashes]  # [words] each
    distinct: Ints  # [distinct]
    whole: tuple[_Hashes, _Hashes]  # [distinct] each


def _hash(rows: Sequence[tuple[str, ...]]) -> _Deletions:
    lengths = np.fromiter(map(len, rows), dtype=np.int64, count=len(rows))
    codes = encode(list(chain.from_iterable(rows))).codes
    starts = np.cumsum(lengths) - lengths
    places = np.arange(len(codes)) - np.repeat(starts, lengths)
    random = np.random.default_rng(1982)
    hashes = [_polynomials(codes, starts, lengths, places, random) for _ in range(2)]
    (without, whole), (without_again, whole_again) = hashes
    first_of_equals = np.unique(whole, return_index=True)[1]
    distinct = first_of_equals[lengths[first_of_equals] > 0]
    is_distinct = np.zeros(len(rows), dtype=bool)
    is_distinct[distinct] = True
    is_kept = np.repeat(is_distinct, lengths)
    return _Deletions(
        rows=np.repeat(np.arange(len(rows)), lengths)[is_kept],
        places=places[is_kept],
        without=(without[is_kept], without_again[is_kept]),
        distinct=distinct,
        whole=(whole[distinct], whole_again[distinct]),
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
    if not len(hashed.distinct):
        return _nothing(), _nothing(), _nothing()
    # ``np.unique`` has sorted the hashes of whole rows.
    near = np.searchsorted(hashed.whole[0], hashed.without[0])
    near = np.minimum(near, len(hashed.distinct) - 1)
    is_equal = (hashed.whole[0][near] == hashed.without[0]) & (
        hashed.whole[1][near] == hashed.without[1]
    )
    at = np.flatnonzero(is_equal)
    shorter, longer, places = hashed.distinct[near[at]], hashed.rows[at], hashed.places[at]
    # A word that stands twice in a row may be deleted at either place.
    width = int(hashed.distinct.max()) + 1
    _, first = np.unique(shorter * width + longer, return_index=True)
    return shorter[first], longer[first], places[first]


def _nothing() -> Ints:
    return np.zeros(0, dtype=np.int64)
