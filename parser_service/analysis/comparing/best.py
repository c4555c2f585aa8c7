"""Which of several parsers is better than all the others, beyond chance."""

from __future__ import annotations

from collections.abc import Sequence

from parser_service.analysis.clustered import Parts, compare
from parser_service.analysis.comparing.significance import LEVEL, holm


def is_better(best: Parts, others: Sequence[Parts]) -> bool:
    """Return whether ``best``, the highest of all, is better than each of the others, of which there is at
    least one.

    A paired bootstrap of clusters and trainings for each, with Holm's correction for their number.
    """
    if not others:
        return False
    p_values = [compare(best, other)[1] for other in others]
    return bool((holm(p_values) <= LEVEL).all())
