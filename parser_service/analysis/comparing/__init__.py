"""Compare runs on the same examples: win, loss and tie, and whether the difference may be chance."""

from __future__ import annotations

from parser_service.analysis.comparing.best import is_better
from parser_service.analysis.comparing.comparisons import (
    Comparison,
    compare_runs,
    count_wins,
)
from parser_service.analysis.comparing.significance import LEVEL, holm

__all__ = [
    "LEVEL",
    "Comparison",
    "compare_runs",
    "count_wins",
    "holm",
    "is_better",
]
