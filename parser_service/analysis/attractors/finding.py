"""Find the forms that attract unlike inputs: the unexpected defaults of Walker, Peng and Cakmak (2019)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from parser_service.analysis.arrays import Bools, Floats, Ints
from parser_service.analysis.attractors.dispersion import compare_dispersion
from parser_service.analysis.labels import Labels, encode
from parser_service.analysis.resampling import SEED

LEVEL = 0.05
MOST_ROWS = 50
MOST_TEXTS = 250  # of each side are compared, drawn at random where there are more


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
    texts = _Texts(utterances, encode(known[1], both.values), known[0], seed)
    rows = _rows(labels, answers, both.values, texts, most)
    return tuple(sorted(rows, key=lambda row: not row.is_attractor))


def _rows(
    labels: Ints, answers: Ints, values: Sequence[str], texts: _Texts, most: int
) -> Iterator[Attractor]:
    """Yield the rows of the first ``most`` forms by q-value; ``values`` are the forms by code."""
    counts = _count(labels, answers, len(values))
    inputs = _Groups(answers, labels != answers)
    owns = _Groups(labels, np.ones(len(labels), dtype=bool))
    for place in counts.ranked()[:most]:
        code = int(counts.forms[place])
        attracted = inputs.of(code)
        spreads = texts.compare(code, attracted, owns.of(code))
        yield counts.row(place, values[code], spreads, attracted)


_Spreads = tuple[float, float, float] | tuple[None, None, None]


@dataclass(frozen=True, eq=False, slots=True)
class _Counts:
    """The codes of the forms that are wrong answers, and the numbers of ``Attractor`` for each: [forms]."""

    forms: Ints
    predicted: Ints
    missed: Ints
    annotated: Ints
    p_values: Floats
    q_values: Floats

    def ranked(self) -> list[int]:
        """Return the places of the forms with a q-value up to ``LEVEL`` in the order of rows."""
        order = np.lexsort((self.forms, -self.predicted, self.q_values))
        ranked: list[int] = order[self.q_values[order] <= LEVEL].tolist()
        return ranked

    def row(self, place: int, form: str, spreads: _Spreads, inputs: Ints) -> Attractor:
        spread, own_spread, spread_p = spreads
        return Attractor(
            form=form,
            predicted=int(self.predicted[place]),
            missed=int(self.missed[place]),
            annotated=int(self.annotated[place]),
            p_value=float(self.p_values[place]),
            q_value=float(self.q_values[place]),
            dispersion=spread,
            own_dispersion=own_spread,
            dispersion_p=spread_p,
            inputs=inputs,
        )


def _count(labels: Ints, answers: Ints, size: int) -> _Counts:
    is_error = labels != answers
    forms = np.unique(answers[is_error])
    predicted, missed, annotated = (
        np.bincount(codes, minlength=size)[forms]
        for codes in (answers[is_error], labels[is_error], labels)
    )
    p_values = _binomial(predicted, missed)
    return _Counts(forms, predicted, missed, annotated, p_values, _false_discovery(p_values))


def _binomial(predicted: Ints, missed: Ints) -> Floats:
    """Return P(as many wrong answers or more), had each of both kinds been equally likely."""
    from scipy.special import bdtrc  # a start can do without it

    p_values: Floats = bdtrc((predicted - 1).astype(float), predicted + missed, 0.5)
    return p_values


def _false_discovery(p_values: Floats) -> Floats:
    """Return q-values (Benjamini and Hochberg, Journal of the Royal Statistical Society B 57, 1995)."""
    from scipy.stats import false_discovery_control  # half a second, which a start can do without

    q_values: Floats = false_discovery_control(p_values) if len(p_values) else p_values
    return q_values


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
        self, utterances: Sequence[str], forms: Labels[str], known: Sequence[str], seed: int
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
