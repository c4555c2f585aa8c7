"""Slices: which predictions a query of a URL chooses, and such queries saved under a name.

A slice is a query of ``PredictionFilters``, as a page's address has it; ``?slice=KEY`` applies a saved one to
every list and comparison of predictions.
"""

from __future__ import annotations

from parser_service.slices.filters import PredictionFilters
from parser_service.slices.saving import delete_slice, rename_slice, save_slice
from parser_service.slices.selecting import describe_query, filters_of, select, slice_query

__all__ = [
    "PredictionFilters",
    "delete_slice",
    "describe_query",
    "filters_of",
    "rename_slice",
    "save_slice",
    "select",
    "slice_query",
]
