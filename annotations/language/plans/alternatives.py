"""Choose among the texts that a recogniser offers for one utterance."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import inf, log

Judge = Callable[[str], float | None]
"""Returns how well a text is understood, the higher the better; None for one that is not."""

# How much a step of a judge's score weighs beside the logarithm of a recogniser's. Of two texts, a filler passed over
# makes one likely a half; a word that was heard as another one, a fifth.
JUDGED = 0.2
MOST_ALTERNATIVES = 20


def best_alternative(alternatives: Sequence[tuple[str, float]], judge: Judge) -> int | None:
    """Return the index of the alternative to answer for; None where none is understood.

    Of those that ``judge`` understands, the one with the highest sum of both scores counts, and among equals the
    first. Without such a one a caller may answer for the first alternative.

    Args:
        alternatives: texts with the recogniser's scores, probabilities (all from 0 to 1) or logarithms of them.
            Those beyond ``MOST_ALTERNATIVES`` are not looked at.
        judge: is asked about each text once.
    """
    offered = alternatives[:MOST_ALTERNATIVES]
    are_probabilities = all(0 <= score <= 1 for _, score in offered)
    best: tuple[float, int] | None = None
    judged: dict[str, float | None] = {}
    for index, (text, score) in enumerate(offered):
        if text not in judged:
            judged[text] = judge(text)
        understood = judged[text]
        if understood is None:
            continue
        likely = (log(score) if score else -inf) if are_probabilities else score
        total = likely + JUDGED * understood
        if best is None or total > best[0]:
            best = total, index
    return None if best is None else best[1]
