"""The commands of one utterance, by the grammar oracle where there is one, by a learned parser elsewhere."""

from __future__ import annotations

from annotations.language.requests import Islands, Judge, Piece, cut, cut_at_joints
from parser_service.parsers.oracle import GrammarOracle

MOST_REPAIRS = 10  # spans that looked like commands and were none


def pieces_of(
    utterance: str, oracle: GrammarOracle | None, judge: Judge | None = None
) -> tuple[Piece, ...]:
    """Return the commands of an utterance, in its order, and its pieces that are not understood.

    An utterance that the oracle understands as one command is one piece. There may be more pieces than a robot takes
    at once.

    Args:
        judge: a learned parser, for what the oracle does not understand.
    """
    if not utterance.strip():
        return ()
    if oracle is None:
        return cut_at_joints(utterance, judge)
    if oracle.understands(utterance):
        return (Piece(0, len(utterance), utterance, True),)
    islands = Islands()
    pieces: tuple[Piece, ...] = ()
    for heard in oracle.islands(utterance):
        islands = islands.union(heard)
        pieces, islands = _cut(utterance, islands, oracle, None)
        if pieces and all(each.is_understood for each in pieces):
            return pieces
    return _cut(utterance, islands, oracle, judge)[0] if judge else pieces


def _cut(
    utterance: str, islands: Islands, oracle: GrammarOracle, judge: Judge | None
) -> tuple[tuple[Piece, ...], Islands]:
    """Cut, and again without the spans of which the oracle makes no form after all."""
    for _ in range(MOST_REPAIRS):
        pieces = cut(utterance, islands, judge)
        taken = {(each.start, each.end) for each in pieces if each.is_understood}
        wrong = {
            span
            for span in islands.spans & taken
            if not oracle.understands(utterance[slice(*span)])
        }
        if not wrong:
            break
        islands = islands.without(wrong)
    return pieces, islands
