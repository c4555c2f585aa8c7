"""How answers change when an utterance is edited, and which words they depend on.

Flips after edits that keep the meaning: Ribeiro et al. (CheckList, ACL 2020). Consistency, that a whole
contrast set is answered right: Gardner et al., Evaluating models' local decision boundaries via contrast
sets, Findings of EMNLP 2020. Leaving out one word at a time: Li, Monroe and Jurafsky, Understanding neural
networks through representation erasure, 2016.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from annotations.language.corpus import wilson_interval
from annotations.language.forms import FormDistances, read_or_none
from parser_service.analysis.arrays import Bools, Floats, Ints
from parser_service.analysis.encoded_labels import distinct_pairs, encode
from parser_service.analysis.intervals import SEED, ratio_interval

ALL_KINDS = "all"
LEVEL = 0.05  # a q-value up to this is called significant

Interval = tuple[float, float]


@dataclass(frozen=True, slots=True)
class EditAnswers:
    """Edits of utterances with the answers of one run, one entry an edit in each list.

    ``bases`` tells the utterances apart that were edited. ``before`` is the answer to the utterance and
    ``after`` to its edit; ``label_before`` and ``label_after`` are the right forms. All are texts; an
    answer need not be a form.
    """

    kinds: Sequence[str]
    bases: Sequence[int]
    before: Sequence[str]
    after: Sequence[str]
    label_before: Sequence[str]
    label_after: Sequence[str]


@dataclass(frozen=True, slots=True)
class Sensitivity:
    """How a run answers ``edits`` of one kind, made of ``bases`` utterances; 95 % intervals beside the numbers.

    ``flip_rate`` is the share of edits whose answer is not equivalent to the answer before: 0 is best for
    edits that keep the meaning, 1 for those that change it. ``distance`` is the mean distance between
    the two answers, 0 to 1, and ``label_distance`` between the two labels. ``consistency`` is the share of
    utterances that are answered right, up to the order of conjuncts, together with all their edits.
    Intervals draw utterances, since edits of the same one are alike; that of the consistency is Wilson's.
    """

    kind: str
    edits: int
    bases: int
    flip_rate: float
    flip_interval: Interval
    distance: float
    distance_interval: Interval
    label_distance: float
    consistency: float
    consistency_interval: Interval


def measure_sensitivity(answers: EditAnswers, seed: int = SEED) -> tuple[Sensitivity, ...]:
    """Return a row for each kind of edit, in the order of their appearance, and one for ``ALL_KINDS`` last.

    Raises:
        ValueError: the lists differ in length.
    """
    lists = [getattr(answers, name) for name in EditAnswers.__slots__]
    if len({len(each) for each in lists}) > 1:
        raise ValueError("Kinds, utterances, answers and labels have to be as many.")
    if not answers.kinds:
        return ()
    outcomes = _Outcomes(answers, seed)
    kinds = encode(answers.kinds)
    rows = [
        outcomes.summarize(kind, np.flatnonzero(kinds.codes == code))
        for code, kind in enumerate(kinds.values)
    ]
    return (*rows, outcomes.summarize(ALL_KINDS, np.arange(len(kinds.codes))))


class _Outcomes:
    """Flip, distances and correctness of every edit, [edits]; each distinct pair of forms is compared once."""

    def __init__(self, answers: EditAnswers, seed: int) -> None:
        self._seed = seed
        self._bases = encode(answers.bases).codes
        texts = [*answers.before, *answers.after, *answers.label_before, *answers.label_after]
        forms = _Forms(texts)
        before, after, label_before, label_after = np.split(forms.numbers, 4)
        self._flips: Bools = before != after
        self._distances = forms.distances(before, after)
        self._label_distances = forms.distances(label_before, label_after)
        self._right: Bools = (before == label_before) & (after == label_after)

    def summarize(self, kind: str, edits: Ints) -> Sensitivity:
        bases = np.unique(self._bases[edits], return_inverse=True)[1]
        sizes = np.bincount(bases).astype(float)
        flips, distances = (
            np.bincount(bases, weights=each[edits]).astype(float)
            for each in (self._flips, self._distances)
        )
        consistent = int((np.bincount(bases, self._right[edits]) == sizes).sum())
        return Sensitivity(
            kind=kind,
            edits=len(edits),
            bases=len(sizes),
            flip_rate=float(flips.sum() / len(edits)),
            flip_interval=self._interval(flips, sizes),
            distance=float(distances.sum() / len(edits)),
            distance_interval=self._interval(distances, sizes),
            label_distance=float(self._label_distances[edits].mean()),
            consistency=consistent / len(sizes),
            consistency_interval=wilson_interval(consistent, len(sizes)),
        )

    def _interval(self, numerators: Floats, denominators: Floats) -> Interval:
        interval = ratio_interval(numerators, denominators, self._seed)
        assert interval is not None  # every kind has an edit
        return interval


class _Forms:
    """Texts as numbers that exactly the equivalent forms share; a text that is no form has its own."""

    def __init__(self, texts: Sequence[str]) -> None:
        encoded = encode(texts)
        read = [read_or_none(text) for text in encoded.values]
        trees = FormDistances()
        names = [
            ("text", text) if form is None else ("form", trees.number(form))
            for text, form in zip(encoded.values, read, strict=True)
        ]
        meanings = encode(names)
        self.numbers = meanings.codes[encoded.codes]
        self._trees = trees
        first = {code: place for place, code in reversed(list(enumerate(meanings.codes.tolist())))}
        self._forms = [read[first[code]] for code in range(len(meanings.values))]

    def distances(self, first: Ints, second: Ints) -> Floats:
        """Return the distance of each pair, 1 where only one is a form and for two unequal texts: [pairs]."""
        left, right, _ = distinct_pairs(first, second)
        values: Floats = np.zeros(len(left))
        for at, (one, other) in enumerate(zip(left.tolist(), right.tolist(), strict=True)):
            first_form, second_form = self._forms[one], self._forms[other]
            if first_form is None or second_form is None:
                values[at] = float(one != other)
            elif one != other:
                values[at] = self._trees.distance(first_form, second_form)
        width = int(second.max(initial=0)) + 1
        places = np.searchsorted(left * width + right, first * width + second)
        distances: Floats = values[places]
        return distances


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
    from scipy.stats import binom, false_discovery_control  # half a second, which a start can spare

    encoded = encode(words)
    trials = encoded.counts()
    changes = np.bincount(encoded.codes[changed], minlength=len(trials))
    total = int(changes.sum())
    # One change and one more trial than seen, so that a rate of 0 is not taken for certain (Laplace).
    rates = (total - changes + 1) / (len(words) - trials + 2)
    p_values: Floats = binom.sf(changes - 1, trials, rates)  # of as many changes or more
    q_values: Floats = false_discovery_control(p_values)
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
