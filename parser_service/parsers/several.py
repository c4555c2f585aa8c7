"""The commands of one utterance, by the grammar oracle where there is one, by a learned parser elsewhere."""

from __future__ import annotations

from collections.abc import Iterator

from annotations.language.plans import Islands, Judge, Piece, cut, cut_at_joints, sentences
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
        return tuple(piece for each in sentences(utterance) for piece in _cut_alone(each, judge))
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


def _cut_alone(sentence: Piece, judge: Judge | None) -> Iterator[Piece]:
    """Yield the commands of a sentence, by a learned parser alone."""
    for each in cut_at_joints(sentence.text, judge):
        start, end = sentence.start + each.start, sentence.start + each.end
        yield Piece(start, end, each.text, each.is_understood)


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
