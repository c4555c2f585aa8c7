"""Compare runs on the same examples: win, loss and tie, and whether the difference may be chance."""

from __future__ import annotations

from parser_service.analysis.comparing.best import is_better
from parser_service.analysis.comparing.comparisons import (
    Comparison,
    compare_runs,
    count_wins,
)

__all__ = [
    "Comparison",
    "compare_runs",
    "count_wins",
    "is_better",
]
