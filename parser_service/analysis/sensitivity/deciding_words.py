"""Which words decide the answers of a parser, and whether it looks at a single one.

Leaving out one word at a time: Li, Monroe and Jurafsky, Understanding neural networks through representation
erasure, 2016.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from parser_service.analysis.arrays import Bools, Floats, Ints
from parser_service.analysis.labels import encode

LEVEL = 0.05


@dataclass(frozen=True, slots=True)
class DecidingWord:
    """``word`` was removed or exchanged ``trials`` times, after which the answer changed ``changes`` times.

    ``rate`` is the share of its trials, ``others_rate`` that of all other words together, and ``share`` is its
    part of all changes. ``p_value`` is of a one-sided binomial test against the others' rate, ``q_value``
    after Benjamini and Hochberg over all words.
    """

    word: str
    trials: int
    changes: int
    others_rate: float
    share: float
    p_value: float
    q_value: float

    @property
    def rate(self) -> float:
        return self.changes / self.trials


@dataclass(frozen=True, eq=False, slots=True)
class Removals:
    """Text k is utterance ``bases[k]`` without one occurrence of ``words[k]``."""

    texts: tuple[str, ...]
    bases: Ints
    words: tuple[str, ...]


def remove_words(utterances: Sequence[str]) -> Removals:
    """Return every utterance without each of its words; words are lower-cased, spaces separate them."""
    rows = [text.split() for text in utterances]
    texts = tuple(
        " ".join((*row[:place], *row[place + 1 :])) for row in rows for place in range(len(row))
    )
    bases = np.repeat(np.arange(len(rows)), [len(row) for row in rows])
    return Removals(texts, bases, tuple(word.lower() for row in rows for word in row))


def find_deciding_words(words: Sequence[str], changed: Bools) -> tuple[DecidingWord, ...]:
    """Return a row for each word, the one that decides most clearly first.

    Args:
        words: the word that each trial removed or exchanged, [trials]. Any other label may stand for
            it, such as the place of the word in its utterance.
        changed: whether the answer changed, [trials]. Where the right form changes too, leave the
            trial out, or call it changed where the answer is wrong.

    Raises:
        ValueError: there are not as many outcomes as words.
    """
    if len(words) != len(changed):
        raise ValueError(f"{len(changed)} outcomes do not fit {len(words)} words.")
    if not len(words):
        return ()
    encoded = encode(words)
    trials = encoded.counts()
    changes = np.bincount(encoded.codes[changed], minlength=len(trials))
    total = int(changes.sum())
    # One change and one more trial than seen, so that a rate of 0 is not taken for certain (Laplace).
    rates = (total - changes + 1) / (len(words) - trials + 2)
    p_values, q_values = _test(changes, trials, rates)
    order = np.lexsort((-changes, p_values))
    return tuple(
        DecidingWord(
            word=encoded.values[place],
            trials=int(trials[place]),
            changes=int(changes[place]),
            others_rate=float((total - changes[place]) / max(len(words) - trials[place], 1)),
            share=float(changes[place] / max(total, 1)),
            p_value=float(p_values[place]),
            q_value=float(q_values[place]),
        )
        for place in order.tolist()
    )


def single_word(rows: Sequence[DecidingWord]) -> DecidingWord | None:
    """Return the word that a parser seems to look at alone; None where it looks at several, or none.

    It is the first row, where that is significant and makes up more than half of all changes. A parser
    that understands its commands depends on verbs, things and places, and on no word so much.
    """
    if not rows or rows[0].q_value > LEVEL or rows[0].share <= 0.5:
        return None
    return rows[0]


def _test(changes: Ints, trials: Ints, rates: Floats) -> tuple[Floats, Floats]:
    """Return P(as many changes or more) for each word at the rate of the others, and q-values."""
    from scipy.stats import binom, false_discovery_control  # half a second, which a start can spare

    p_values: Floats = binom.sf(changes - 1, trials, rates)
    return p_values, false_discovery_control(p_values)
