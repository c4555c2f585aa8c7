"""Find the commands of an utterance that holds several, by what a parser understands."""

from __future__ import annotations

from collections.abc import Sequence

from annotations.language.requests import cut_commands
from parser_service.parsers.interface import UNKNOWN, Check, Parser, keep_going


def commands_in(parser: Parser, utterance: str, check: Check = keep_going) -> tuple[str, ...]:
    """Return the commands of an utterance, three at most, in its order.

    It is one command where ``parser`` understands it as it is, or where no cut gives commands that it understands.
    ``parser`` is to hesitate: one that answers anything takes everything for a command.
    """

    def judge(pieces: Sequence[str]) -> list[float | None]:
        answers = parser.predict(pieces, 1, check)
        return [each[0].score if each and each[0].form != UNKNOWN else None for each in answers]

    return cut_commands(utterance, judge)
