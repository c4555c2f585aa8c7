"""Find the neighbour of an utterance whose answer is further away than its label is."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from annotations.language.forms import Form, FormDistances
from parser_service.analysis.categories.evidence import Neighbour


def furthest(gold: Form, predicted: Form, neighbours: Sequence[Neighbour]) -> Neighbour | None:
    """Return the neighbour whose answer differs most from ``predicted`` beyond what its label differs
    from ``gold``; the first of equals, None where no answer differs more than the labels do."""
    if not neighbours:
        return None

    def excess(neighbour: Neighbour) -> float:
        answers = 1.0
        if neighbour.answer is not None:
            answers = _distance(predicted, neighbour.answer)
        return answers - _distance(gold, neighbour.gold)

    best = max(neighbours, key=excess)
    return best if excess(best) > 0 else None


@lru_cache(maxsize=1 << 16)
def _distance(first: Form, second: Form) -> float:
    return FormDistances().distance(first, second)
