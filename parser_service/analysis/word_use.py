"""Which predicates the words of utterances go with in training."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from annotations.language.forms import head_predicate, predicates, read_or_none
from annotations.language.texts import ARTICLES
from parser_service.analysis.arrays import Bools, Floats, Ints
from parser_service.parsers.remembering import remembered

if TYPE_CHECKING:
    from scipy.sparse import csr_array

LEAST_PAIRS = 5  # of training, that have the word and go with the one side
STRONG = 3.0  # log odds: a word is 20 times as frequent on one side as on the other
FAMILIAR = 0.01  # share of the pairs with a head predicate that have a word of theirs
_SMOOTHING = 0.5  # pairs
_Predicates = frozenset[str]


@dataclass(frozen=True, slots=True)
class SpokenFor:
    """``word`` occurs in ``with_answer`` training pairs with what only the answer has, and in ``with_label``
    pairs with what only the label has."""

    word: str
    with_answer: int
    with_label: int


class WordUse:
    """Counts the training pairs of each form that have a word; words of fewer than ``LEAST_PAIRS`` pairs do not
    count.

    Args:
        pairs: the words of an utterance, and its label as text; labels that are no form do not count.
    """

    def __init__(self, pairs: Iterable[tuple[Sequence[str], str]]) -> None:
        by_label: defaultdict[str, Counter[str]] = defaultdict(Counter)
        per_label: Counter[str] = Counter()
        for words, label in pairs:
            by_label[label].update(_content(words))
            per_label[label] += 1
        self._labels = frozenset(per_label)
        read = {label: read_or_none(label) for label in per_label}
        forms = {label: form for label, form in read.items() if form is not None}
        self._predicates = [frozenset(predicates(form)) for form in forms.values()]
        self._heads = np.array([head_predicate(form) for form in forms.values()], dtype=object)
        self._pairs: Ints = np.array([per_label[label] for label in forms], dtype=np.int64)
        self._places, self._counts = _count([by_label[label] for label in forms])

    def knows(self, label: str) -> bool:
        """Tell whether training has the label."""
        return label in self._labels

    def is_familiar(self, words: Iterable[str], head: str) -> bool:
        """Tell whether at least half of the words are usual where labels have this head predicate."""
        said = _content(words)
        usual = self._usual_words(head)
        known = sum(bool(usual[self._places[word]]) for word in said if word in self._places)
        return 2 * known >= len(said) > 0

    def speaks_for(
        self, words: Iterable[str], more: _Predicates, less: _Predicates
    ) -> SpokenFor | None:
        """Return the word that speaks most for ``more``; None where no word does so strongly, or all words
        together speak for ``less``.

        Args:
            words: those of an utterance.
            more: the predicates that the answer has and the label has not.
            less: the opposite.
        """
        if not more or not less:
            return None
        said = sorted(word for word in _content(words) if word in self._places)
        odds = self._compare(more, less)
        if odds is None or not said:
            return None
        places = [self._places[word] for word in said]
        strong = odds.strong[places]
        if not strong.any() or odds.log_odds[places].sum() <= 0:
            return None
        best = int(np.argmax(np.where(strong, odds.log_odds[places], -np.inf)))
        at = places[best]
        return SpokenFor(said[best], int(odds.with_answer[at]), int(odds.with_label[at]))

    @remembered(4096)
    def _compare(self, more: _Predicates, less: _Predicates) -> _Odds | None:
        """Compare the words of pairs with all of ``more`` and none of ``less``, and the opposite; None where
        training lacks either."""
        of_answer, of_label = self._having(more, less), self._having(less, more)
        if not of_answer.any() or not of_label.any():
            return None
        with_answer, with_label = (self._words_of(each) for each in (of_answer, of_label))
        shares = (
            (counts + _SMOOTHING) / (self._pairs[mask].sum() + 1)
            for counts, mask in ((with_answer, of_answer), (with_label, of_label))
        )
        log_odds = np.log(np.divide(*shares))
        log_odds[np.maximum(with_answer, with_label) < LEAST_PAIRS] = 0
        strong = (log_odds >= STRONG) & (with_answer >= LEAST_PAIRS)
        return _Odds(log_odds, strong, with_answer, with_label)

    def _having(self, have: _Predicates, lack: _Predicates) -> Bools:
        """Return which forms have all of ``have`` and none of ``lack``, [forms]."""
        chosen = (have <= used and not lack & used for used in self._predicates)
        return np.fromiter(chosen, dtype=bool, count=len(self._predicates))

    def _words_of(self, forms: Bools) -> Ints:
        """Return how many pairs with these forms have each word, [words]."""
        counts: Ints = forms.astype(np.int64) @ self._counts
        return counts

    @remembered(256)
    def _usual_words(self, head: str) -> Bools:
        """Return which words are usual in pairs with this head predicate, [words]."""
        forms = np.asarray(self._heads == head, dtype=bool)
        counts = self._words_of(forms)
        usual: Bools = (counts > 0) & (counts >= FAMILIAR * self._pairs[forms].sum())
        return usual


@dataclass(frozen=True, eq=False, slots=True)
class _Odds:
    """[words] each."""

    log_odds: Floats
    strong: Bools
    with_answer: Ints
    with_label: Ints


def _content(words: Iterable[str]) -> set[str]:
    """Return the words without articles and class tokens."""
    return {word for word in words if word not in ARTICLES and not word.startswith("<")}


def _count(of_forms: Sequence[Counter[str]]) -> tuple[dict[str, int], csr_array]:
    """Return the place of each word that is frequent enough, and the counts of words, [forms, words]."""
    from scipy.sparse import csr_array  # half a second at the start of every process

    together: Counter[str] = Counter()
    for counts in of_forms:
        together.update(counts)
    frequent = sorted(word for word, count in together.items() if count >= LEAST_PAIRS)
    places = {word: place for place, word in enumerate(frequent)}
    kept = [{places[word]: n for word, n in each.items() if word in places} for each in of_forms]
    starts = np.cumsum([0, *map(len, kept)])
    columns: NDArray[np.int64] = np.fromiter(chain.from_iterable(kept), dtype=np.int64)
    values = np.fromiter(
        chain.from_iterable(each.values() for each in kept), dtype=np.int64, count=len(columns)
    )
    return places, csr_array((values, columns, starts), shape=(len(of_forms), len(places)))
