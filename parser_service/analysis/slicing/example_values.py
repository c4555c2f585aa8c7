"""What an example can be sliced by: its head predicate, length and depth, and whether its form was seen.

All take a list as long as the examples. Forms are texts in any notation that ``read_form`` reads,
each distinct one read once; a text that is not a form is labelled ``NO_FORM``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise
from typing import TypeVar

import numpy as np

from annotations.language.forms import Form, depth, head_predicate
from parser_service.analysis.arrays import Bools
from parser_service.analysis.labels import encode
from parser_service.analysis.reading import NO_FORM, read_or_none

# Lengths at which a bin begins, in words; the published paraphrases have 2 to 34, the median is 9.
BIN_STARTS = (1, 5, 9, 13, 17)

Value = TypeVar("Value")


def head_predicates(forms: Sequence[str]) -> list[str]:
    """Return the head predicate of each form; ``UNKNOWN`` for one without."""
    return _of_distinct(forms, head_predicate, NO_FORM)


def form_depths(forms: Sequence[str]) -> list[int | str]:
    """Return how deep λs and applications nest in each form, from 0 for ``UNKNOWN``."""
    return _of_distinct(forms, depth, NO_FORM)


def count_words(utterances: Sequence[str]) -> list[int]:
    """Return the number of words of each utterance; words are what spaces separate."""
    return [len(text.split()) for text in utterances]


def length_bins(utterances: Sequence[str], starts: Sequence[int] = BIN_STARTS) -> list[str]:
    """Return for each utterance the bin of its number of words, such as ``5–8 words``.

    Args:
        utterances: texts.
        starts: the smallest number of words of each bin, ascending. An utterance below the first
            is in the first bin.
    """
    names = bin_names(starts)
    places = np.digitize(count_words(utterances), starts[1:])
    return [names[place] for place in places.tolist()]


def bin_names(starts: Sequence[int] = BIN_STARTS) -> tuple[str, ...]:
    """Return the names of the bins of ``length_bins``, shortest first."""
    inner = (f"{low}–{high - 1} words" for low, high in pairwise(starts))
    return (*inner, f"{starts[-1]} words or more")


def are_seen(forms: Sequence[str], training_forms: Iterable[str]) -> Bools:
    """Return whether each form, canonical text, is among those of the training pairs: [examples]."""
    known = frozenset(training_forms)
    return np.fromiter((form in known for form in forms), dtype=bool, count=len(forms))


def _of_distinct(
    forms: Sequence[str], value_of: Callable[[Form], Value], otherwise: str
) -> list[Value | str]:
    encoded = encode(forms)
    read = (read_or_none(text) for text in encoded.values)
    values = [otherwise if form is None else value_of(form) for form in read]
    return [values[code] for code in encoded.codes.tolist()]
