"""Which predicates the words of utterances go with in training."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import log

from annotations.language.english import ARTICLES
from annotations.language.forms import head_predicate, predicates
from parser_service.analysis.reading import read_or_none

LEAST_PAIRS = 5  # of training, that have the word and go with the one side
STRONG = 3.0  # log odds: a word is 20 times as frequent on one side as on the other
FAMILIAR = 0.01  # share of the pairs with a head predicate that have a word of theirs
_SMOOTHING = 0.5  # pairs


@dataclass(frozen=True, slots=True)
class SpokenFor:
    """``word`` stands in ``with_answer`` training pairs that have what the answer has and the label has
    not, and in ``with_label`` pairs of the opposite kind."""

    word: str
    with_answer: int
    with_label: int


class WordUse:
    """Counts the training pairs of each form that have a word.

    Args:
        pairs: the words of an utterance, and its label as text; labels that are no form do not count.
    """

    def __init__(self, pairs: Iterable[tuple[Sequence[str], str]]) -> None:
        self._words: defaultdict[str, Counter[str]] = defaultdict(Counter)  # by form
        self._pairs: Counter[str] = Counter()
        for words, label in pairs:
            self._words[label].update(_content(words))
            self._pairs[label] += 1
        read = {label: read_or_none(label) for label in self._pairs}
        forms = {label: form for label, form in read.items() if form is not None}
        self._predicates = {label: frozenset(predicates(form)) for label, form in forms.items()}
        self._odds: dict[tuple[frozenset[str], frozenset[str]], Mapping[str, _Odds]] = {}
        self._familiar: dict[str, frozenset[str]] = {}
        self._heads = {label: head_predicate(form) for label, form in forms.items()}

    def knows(self, label: str) -> bool:
        """Tell whether training has the label."""
        return label in self._pairs

    def is_familiar(self, words: Iterable[str], head: str) -> bool:
        """Tell whether at least half of the words are usual where labels have this head predicate."""
        said = _content(words)
        return 2 * len(said & self._usual_words(head)) >= len(said) > 0

    def _usual_words(self, head: str) -> frozenset[str]:
        if head not in self._familiar:
            labels = [label for label, name in self._heads.items() if name == head]
            counts: Counter[str] = Counter()
            for label in labels:
                counts += self._words[label]
            least = FAMILIAR * sum(self._pairs[label] for label in labels)
            usual = frozenset(word for word, count in counts.items() if count >= least)
            self._familiar[head] = usual
        return self._familiar[head]

    def speaks_for(
        self, words: Iterable[str], more: frozenset[str], less: frozenset[str]
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
        odds = self._compare(more, less)
        counted = [(odds[word], word) for word in sorted(_content(words)) if word in odds]
        strong = [(each, word) for each, word in counted if each.is_strong]
        if not strong or sum(each.log_odds for each, _ in counted) <= 0:
            return None
        best, word = max(strong, key=lambda item: item[0].log_odds)
        return SpokenFor(word, best.with_answer, best.with_label)

    def _compare(self, more: frozenset[str], less: frozenset[str]) -> Mapping[str, _Odds]:
        """Return the odds of each word between pairs with all of ``more`` and none of ``less``, and the
        opposite; no word where training lacks either."""
        if (more, less) not in self._odds:
            self._odds[more, less] = dict(self._odds_of(more, less))
        return self._odds[more, less]

    def _odds_of(self, more: frozenset[str], less: frozenset[str]) -> Iterable[tuple[str, _Odds]]:
        for_answer, answers = self._count(more, less)
        for_label, labels = self._count(less, more)
        if not answers or not labels:
            return
        for word in for_answer | for_label:
            first, second = for_answer[word], for_label[word]
            if max(first, second) >= LEAST_PAIRS:
                of_answer = (first + _SMOOTHING) / (answers + 1)
                of_label = (second + _SMOOTHING) / (labels + 1)
                yield word, _Odds(log(of_answer / of_label), first, second)

    def _count(self, have: frozenset[str], lack: frozenset[str]) -> tuple[Counter[str], int]:
        """Return how many pairs have each word, of the forms with all of ``have`` and none of ``lack``, and
        how many such pairs there are."""
        words: Counter[str] = Counter()
        pairs = 0
        for label, used in self._predicates.items():
            if have <= used and not lack & used:
                words += self._words[label]
                pairs += self._pairs[label]
        return words, pairs


def _content(words: Iterable[str]) -> set[str]:
    """Return the words without articles and class tokens."""
    return {word for word in words if word not in ARTICLES and not word.startswith("<")}


@dataclass(frozen=True, slots=True)
class _Odds:
    log_odds: float
    with_answer: int
    with_label: int

    @property
    def is_strong(self) -> bool:
        return self.log_odds >= STRONG and self.with_answer >= LEAST_PAIRS
