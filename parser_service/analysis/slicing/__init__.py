"""Accuracy of runs on slices of a test part, and the values of an example that slices are made of."""

from __future__ import annotations

from parser_service.analysis.reading import NO_FORM
from parser_service.analysis.slicing.accuracies import (
    SliceAccuracies,
    accuracy_by,
    accuracy_where,
)
from parser_service.analysis.slicing.example_values import (
    are_seen,
    bin_names,
    count_words,
    form_depths,
    head_predicates,
    length_bins,
)

__all__ = [
    "NO_FORM",
    "SliceAccuracies",
    "accuracy_by",
    "accuracy_where",
    "are_seen",
    "bin_names",
    "count_words",
    "form_depths",
    "head_predicates",
    "length_bins",
]
