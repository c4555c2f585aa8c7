"""Find the forms that attract unlike inputs: the unexpected defaults of Walker, Peng and Cakmak (2019).

The distance of two texts is 1 − the cosine of their tf-idf vectors (Salton and Buckley, Information
Processing and Management 24, 1988). The mean distance of all pairs of a group follows from the sum of its
vectors, ‖Σv‖² = Σ‖v‖² + Σ cosines, so no pair is looked at.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from parser_service.analysis.arrays import Bools, Floats, Ints
from parser_service.analysis.encoded_labels import EncodedLabels, encode
from parser_service.analysis.intervals import SEED

LEVEL = 0.05
MOST_ROWS = 50
MOST_TEXTS = 250  # of each side are compared, drawn at random where there are more
PERMUTATIONS = 999
_WORD = re.compile(r"<\w+>|\w+")
_Spreads = tuple[float, float, float] | tuple[None, None, None]


@dataclass(frozen=True, eq=False, slots=True)
class Attractor:
    """A form that stands more often in wrong answers than it is missed.

    Among the errors, ``predicted`` answers are the form and ``missed`` labels are; ``annotated`` counts all
    labels. ``p_value`` is of a one-sided binomial test that an error has it as its label as often as its answer,
    ``q_value`` the same after Benjamini and Hochberg over all forms. ``dispersion`` is the mean tf-idf
    distance between its wrong inputs, ``own_dispersion`` between inputs that are labelled with it, and
    ``dispersion_p`` of a permutation test that the first is not greater; they are None where one side
    has fewer than two texts. ``inputs`` are the places of its wrong inputs.
    """

    form: str
    predicted: int
    missed: int
    annotated: int
    p_value: float
    q_value: float
    dispersion: float | None
    own_dispersion: float | None
    dispersion_p: float | None
    inputs: Ints

    @property
    def is_attractor(self) -> bool:
        """Whether both tests say so; the first alone, where the form has no inputs of its own."""
        is_frequent = self.q_value <= LEVEL
        return is_frequent and (self.dispersion_p is None or self.dispersion_p <= LEVEL)


def find_attractors(
    utterances: Sequence[str],
    gold: Sequence[str],
    predicted: Sequence[str],
    known: tuple[Sequence[str], Sequence[str]] = ((), ()),
    most: int = MOST_ROWS,
    seed: int = SEED,
) -> tuple[Attractor, ...]:
    """Return the forms that are in wrong answers more often than chance allows, attractors first.

    Args:
        utterances: the texts, [examples].
        gold: canonical text of each label, [examples].
        predicted: canonical text of each answer, or the parser's text: [examples].
        known: utterances and their forms from the training pairs: further inputs of a form's own. Hand in those
            of the same source only, since generated commands are less varied than what people say.
        most: rows to return; only these are tested for dispersion.
        seed: of the texts and permutations that are drawn.

    Returns:
        Rows with a q-value up to ``LEVEL``; ordered by whether both tests agree, then by q-value, then
        by ``predicted``.

    Raises:
        ValueError: the lists differ in length.
    """
    if not len(utterances) == len(gold) == len(predicted):
        raise ValueError("Utterances, labels and answers have to be as many.")
    both = encode([*gold, *predicted])
    labels, answers = both.codes[: len(gold)], both.codes[len(gold) :]
    is_error = labels != answers
    # The codes of the forms that are wrong answers, and the numbers of ``Attractor`` for each: [forms].
    forms = np.unique(answers[is_error])
    answered, missed, annotated = (
        np.bincount(codes, minlength=len(both.values))[forms]
        for codes in (answers[is_error], labels[is_error], labels)
    )
    p_values, q_values = _test(answered, missed)
    order = np.lexsort((forms, -answered, q_values))
    texts = _Texts(utterances, encode(known[1], both.values), known[0], seed)
    inputs = _Groups(answers, is_error)
    owns = _Groups(labels, np.ones(len(labels), dtype=bool))
    rows = []
    for place in order[q_values[order] <= LEVEL][:most].tolist():
        code = int(forms[place])
        attracted = inputs.of(code)
        spread, own_spread, spread_p = texts.compare(code, attracted, owns.of(code))
        rows.append(
            Attractor(
                form=both.values[code],
                predicted=int(answered[place]),
                missed=int(missed[place]),
                annotated=int(annotated[place]),
                p_value=float(p_values[place]),
                q_value=float(q_values[place]),
                dispersion=spread,
                own_dispersion=own_spread,
                dispersion_p=spread_p,
                inputs=attracted,
            )
        )
    return tuple(sorted(rows, key=lambda row: not row.is_attractor))


def _test(answered: Ints, missed: Ints) -> tuple[Floats, Floats]:
    """Return P(as many wrong answers or more), had each of both kinds been equally likely, and the q-values
    (Benjamini and Hochberg, Journal of the Royal Statistical Society B 57, 1995): [forms] each."""
    from scipy.special import bdtrc  # half a second, which a start can do without
    from scipy.stats import false_discovery_control

    p_values: Floats = bdtrc((answered - 1).astype(float), answered + missed, 0.5)
    q_values: Floats = false_discovery_control(p_values) if len(p_values) else p_values
    return p_values, q_values


class _Groups:
    """The places of each code among those of a mask, sorted once."""

    def __init__(self, codes: Ints, mask: Bools) -> None:
        self._places = np.flatnonzero(mask)
        self._places = self._places[np.argsort(codes[self._places], kind="stable")]
        self._codes = codes[self._places]

    def of(self, code: int) -> Ints:
        start, end = np.searchsorted(self._codes, [code, code + 1])
        return self._places[start:end]


class _Texts:
    """Draws the texts of a form to compare."""

    def __init__(
        self, utterances: Sequence[str], forms: EncodedLabels[str], known: Sequence[str], seed: int
    ) -> None:
        self._utterances, self._known, self._seed = utterances, known, seed
        self._of_known = _Groups(forms.codes, np.ones(len(forms.codes), dtype=bool))

    def compare(self, code: int, attracted: Ints, own: Ints) -> _Spreads:
        random = np.random.default_rng((self._seed, code))
        first = self._draw(self._utterances, attracted, random)
        second = self._draw(self._utterances, own, random)
        second += self._draw(self._known, self._of_known.of(code), random)
        if min(len(first), len(second)) < 2:
            return None, None, None
        return compare_dispersion(first, second[:MOST_TEXTS], self._seed)

    def _draw(self, texts: Sequence[str], places: Ints, random: np.random.Generator) -> list[str]:
        if len(places) > MOST_TEXTS:
            places = random.choice(places, MOST_TEXTS, replace=False)
        return [texts[place] for place in places.tolist()]


def unit_vectors(texts: Sequence[str]) -> Floats:
    """Return the tf-idf vectors of texts, of length 1, or 0 for a text without words: [texts, words]."""
    words = [_WORD.findall(text.lower()) for text in texts]
    vocabulary = encode([word for row in words for word in row])
    counts = np.zeros((len(texts), len(vocabulary.values)))
    rows = np.repeat(np.arange(len(texts)), [len(row) for row in words])
    np.add.at(counts, (rows, vocabulary.codes), 1.0)
    in_texts = (counts > 0).sum(axis=0)  # [words]
    vectors = counts * (1 + np.log((1 + len(texts)) / (1 + in_texts)))
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    unit: Floats = np.divide(vectors, lengths, out=vectors, where=lengths > 0)
    return unit


def compare_dispersion(
    first: Sequence[str], second: Sequence[str], seed: int, permutations: int = PERMUTATIONS
) -> tuple[float, float, float]:
    """Test whether the texts of one group are more unlike each other than those of another.

    A one-sided permutation test (SciPy's) of the difference between the mean distances; where there are
    few ways to deal the texts to two groups, all of them are tried.

    Args:
        first: at least two texts.
        second: at least two texts.
        seed: equal seeds give equal results.
        permutations: how many are drawn at most.

    Returns:
        The mean distance in each group, and the p-value.
    """
    from scipy.stats import permutation_test  # half a second, which a start can do without

    vectors = unit_vectors([*first, *second])
    places = np.arange(len(vectors))
    groups = places[: len(first)], places[len(first) :]

    def difference(some: Ints, others: Ints, axis: int) -> Floats:
        return mean_distances(vectors, some) - mean_distances(vectors, others)

    result = permutation_test(
        groups,
        difference,
        vectorized=True,
        n_resamples=permutations,
        alternative="greater",
        rng=np.random.default_rng(seed),
    )
    one, other = (float(mean_distances(vectors, group)) for group in groups)
    return one, other, float(result.pvalue)


def mean_distances(vectors: Floats, places: Ints) -> Floats:
    """Return the mean distance within each group of places, [..., group] → [...]."""
    members = np.zeros((*places.shape[:-1], len(vectors)))
    np.put_along_axis(members, places, 1.0, axis=-1)
    sums = members @ vectors
    own = members @ (vectors**2).sum(axis=1)
    size = places.shape[-1]
    cosines = (sums**2).sum(axis=-1) - own
    distances: Floats = 1 - cosines / (size * (size - 1))
    return distances
