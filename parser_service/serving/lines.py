"""Lines with an utterance in each, and an answer to each in their order."""

from __future__ import annotations

import json
import logging
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from annotations.language.texts import Refusal
from parser_service.serving.answerer import Answer, Answerer, NotServed
from parser_service.serving.parse_answers import as_json
from parser_service.serving.preparing import numbered_lines, require_utterance

logger = logging.getLogger(__name__)

FAILED = "the parser failed. The log of the server or worker that ran it says why."


@dataclass(frozen=True, slots=True)
class LineAnswer:
    """What came of line ``number``: the answer as JSON, or in ``fault`` a sentence about what is wrong with it."""

    number: int
    json: str = ""
    fault: str = ""


def answer_lines(answerer: Answerer, body: bytes, beam: int) -> Iterator[list[str]]:
    """Yield the answers to JSON lines as JSON, some at a time. What is wrong with a line is said in its place."""
    numbered = numbered_lines(body)
    together = answerer.lines_together
    for at in range(0, len(numbered), together):
        # One thread does both. A second one that parsed the next lines meanwhile would have to wait for
        # the interpreter's lock after each operation of the network, for longer than writing takes.
        answers = answer_some(answerer, numbered[at : at + together], beam, _read_json_line)
        yield [each.json or _refuse_line(each) for each in answers]


def answer_some(
    answerer: Answerer,
    lines: Sequence[tuple[int, bytes]],
    beam: int,
    read: Callable[[bytes], str],
) -> list[LineAnswer]:
    """Return what the parser answers to each of the numbered lines, asked together.

    Args:
        read: returns the utterance of a line, empty where there is nothing to parse; raises Refusal for a line
            that cannot be read.
    """
    faults: dict[int, str] = {}
    utterances: dict[int, str] = {}
    for number, line in lines:
        try:
            utterances[number] = read(line)
        except Refusal as error:
            faults[number] = error.message
    spoken = {number: utterance for number, utterance in utterances.items() if utterance}
    answers = dict.fromkeys(utterances, answerer.heard_nothing())
    try:
        asked = answerer.ask(list(spoken.values()), beam) if spoken else []
        answers |= zip(spoken, asked, strict=True)
    except NotServed as error:
        faults |= dict.fromkeys(spoken, error.message)
    except Exception:
        logger.exception("A batch for %s", answerer.world)
        faults |= dict.fromkeys(spoken, FAILED)
    return [
        LineAnswer(number, fault=faults[number])
        if number in faults
        else _write(answerer, number, answers[number])
        for number, _ in lines
    ]


def _write(answerer: Answerer, number: int, answer: Answer) -> LineAnswer:
    try:
        return LineAnswer(number, answerer.write(answer))
    except Exception:
        logger.exception("Line %s of a batch for %s", number, answerer.world)
        return LineAnswer(number, fault=FAILED)


def _refuse_line(answer: LineAnswer) -> str:
    return as_json({"line": answer.number, "detail": f"Line {answer.number}: {answer.fault}"})


def _read_json_line(line: bytes) -> str:
    return require_utterance(utterance_in(read_object(line)))


def utterance_in(line: Mapping[str, Any]) -> object:
    """Return the utterance of a JSON line, or the command where it has none. Raises Refusal without either."""
    for name in ("utterance", "command"):
        if name in line:
            return line[name]
    raise Refusal('The object has neither an "utterance" nor a "command".', "no_utterance")


def read_object(body: bytes | str) -> dict[str, Any]:
    """Return the JSON object that ``body`` writes. Raises Refusal."""
    try:
        value = json.loads(body)
    except (ValueError, RecursionError):
        value = None
    if not isinstance(value, dict):
        raise Refusal(
            'This is not a JSON object such as {"utterance": "bring me the apple"}.',
            "not_a_json_object",
        )
    return value
