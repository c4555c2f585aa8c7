"""The first answers of a run to one part of its split, small enough in memory for a million of them."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from django.db.models import QuerySet

from parser_service.analysis.arrays import Bools, Floats
from parser_service.analysis.slicing import form_depths, head_predicates, length_bins
from parser_service.models import Prediction, TrainingRun

ROWS_AT_ONCE = 5_000
COLUMNS = (
    *("example__utterance", "example__logical_form", "example__task_category", "example__source"),
    *("label_in_training", "logical_form", "is_exact_match", "is_equivalent", "is_well_formed"),
    "score",
)
SEEN = "in the training pairs"
NOT_SEEN = "not in the training pairs"
NOT_KNOWN = "not known"
NO_CATEGORY = "none"


@dataclass(slots=True)
class Texts:
    """A column of texts, of which many are equal: each distinct one is held once."""

    places: dict[str, int] = field(default_factory=dict)
    codes: array[int] = field(default_factory=lambda: array("i"))

    def extend(self, texts: Iterable[str]) -> None:
        places = self.places
        self.codes.extend(places.setdefault(text, len(places)) for text in texts)

    def spelled(self) -> list[str]:
        """Return the column, one text an example."""
        return self.mapped(lambda values: values)

    def mapped(self, convert: Callable[[list[str]], Sequence[Any]]) -> list[Any]:
        """Return the column with its distinct texts converted, all of them at once."""
        values = convert(list(self.places))
        return [values[code] for code in self.codes]


class Answers:
    """What a report counts, one entry an example, in the order of the examples."""

    def __init__(self, run: TrainingRun, part: str) -> None:
        self.run, self.part = run, part
        self._labels, self._answers = Texts(), Texts()
        self._categories, self._sources, self._bins, self._seen = Texts(), Texts(), Texts(), Texts()
        self._flags = tuple(bytearray() for _ in range(3))
        self._scores: array[float] = array("d")
        rows = answers_of(run, part).values_list(*COLUMNS).iterator(chunk_size=ROWS_AT_ONCE)
        chunk: list[tuple[Any, ...]] = []
        for row in rows:
            chunk.append(row)
            if len(chunk) == ROWS_AT_ONCE:
                self._add(chunk)
                chunk = []
        if chunk:
            self._add(chunk)

    def _add(self, rows: list[tuple[Any, ...]]) -> None:
        texts, labels, categories, sources, seen, answers, *flags, scores = zip(*rows, strict=True)
        self._labels.extend(labels)
        self._answers.extend(answers)
        self._categories.extend(category or NO_CATEGORY for category in categories)
        self._sources.extend(sources)
        self._bins.extend(length_bins(texts))
        self._seen.extend(map(_say_seen, seen))
        for stored, added in zip(self._flags, flags, strict=True):
            stored.extend(map(bool, added))
        self._scores.extend(scores)

    def __len__(self) -> int:
        return len(self._scores)

    @cached_property
    def is_right(self) -> Bools:
        return np.frombuffer(self._flags[0], dtype=np.bool_)

    @cached_property
    def scores(self) -> Floats:
        return np.frombuffer(self._scores, dtype=np.float64)

    @property
    def labels(self) -> list[str]:
        return self._labels.spelled()

    @property
    def answers(self) -> list[str]:
        return self._answers.spelled()

    def slices(self) -> Iterable[tuple[str, list[Hashable]]]:
        """Yield what examples are sliced by, and the slice of each example."""
        yield "Source", self._sources.spelled()
        yield "Task category", self._categories.spelled()
        yield "Head predicate", self._labels.mapped(head_predicates)
        yield "Length of the utterance", self._bins.spelled()
        yield "Depth of the form", self._labels.mapped(form_depths)
        yield "Form in training", self._seen.spelled()


def answers_of(run: TrainingRun, part: str) -> QuerySet[Prediction]:
    """Return the first answers to the examples of a part, in their order."""
    return run.predictions.best().filter(example__part=part).order_by("example_id")


def _say_seen(count: int | None) -> str:
    if count is None:
        return NOT_KNOWN
    return SEEN if count else NOT_SEEN
