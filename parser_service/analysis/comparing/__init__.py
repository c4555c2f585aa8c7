"""Compare runs on the same examples: win, loss and tie, and whether the difference may be chance."""

from __future__ import annotations

from parser_service.analysis.comparing.comparisons import (
    LEVEL,
    Comparison,
    compare_runs,
    count_wins,
)
from parser_service.analysis.comparing.significance import holm, mcnemar, paired_bootstrap

__all__ = [
    "LEVEL",
    "Comparison",
    "compare_runs",
    "count_wins",
    "holm",
    "mcnemar",
    "paired_bootstrap",
]
