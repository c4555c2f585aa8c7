"""Accuracy of runs on slices of a test part, and the values of an example that slices are made of."""

from __future__ import annotations

from parser_service.analysis.reading import NO_FORM
from parser_service.analysis.slicing.accuracies import (
    SliceAccuracies,
    accuracy_by,
    accuracy_of_labels,
    accuracy_where,
)
from parser_service.analysis.slicing.example_values import (
    BIN_STARTS,
    are_seen,
    bin_names,
    form_depths,
    head_predicates,
    length_bins,
)

__all__ = [
    "BIN_STARTS",
    "NO_FORM",
    "SliceAccuracies",
    "accuracy_by",
    "accuracy_of_labels",
    "accuracy_where",
    "are_seen",
    "bin_names",
    "form_depths",
    "head_predicates",
    "length_bins",
]
