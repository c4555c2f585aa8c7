"""JSON lines: an utterance in each, and an answer to each in their order."""

from __future__ import annotations

import json
import logging
from collections.abc import Iterator
from typing import Any

from annotations.language.errors import Refusal
from parser_service.serving.parse_answers import as_json
from parser_service.serving.preparing import numbered_lines, require_utterance
from parser_service.serving.shelf import AskedUtterance, NotServed, ServedParser

logger = logging.getLogger(__name__)

FAILED = "the parser failed. The log of the server or worker that ran it says why."


def answer_lines(service: ServedParser, body: bytes, beam: int) -> Iterator[list[str]]:
    """Yield the answers as JSON, some at a time. What is wrong with a line is said in its place."""
    numbered = numbered_lines(body)
    together = service.parser.lines_together
    for at in range(0, len(numbered), together):
        # One thread does both. A second one that parsed the next lines meanwhile would have to wait for
        # the interpreter's lock after each operation of the network, for longer than writing takes.
        answers = _ask_some(service, numbered[at : at + together], beam)
        yield [_write(service, *answer) for answer in answers.items()]


def _ask_some(
    service: ServedParser, lines: list[tuple[int, bytes]], beam: int
) -> dict[int, AskedUtterance | str]:
    """Return what the parser answers to each line, by its number; what is wrong with one as JSON."""
    answers: dict[int, AskedUtterance | str] = dict.fromkeys((number for number, _ in lines), "")
    utterances: dict[int, str] = {}
    for number, line in lines:
        try:
            utterances[number] = require_utterance(read_object(line).get("utterance"))
        except Refusal as error:
            answers[number] = _refuse_line(number, error.message)
    try:
        asked = service.ask(list(utterances.values()), beam) if utterances else []
        answers |= zip(utterances, asked, strict=True)
    except NotServed as error:
        answers |= {number: _refuse_line(number, error.message) for number in utterances}
    except Exception:
        logger.exception("A batch for %s", service.world)
        answers |= {number: _refuse_line(number, FAILED) for number in utterances}
    return answers


def _write(service: ServedParser, number: int, answer: AskedUtterance | str) -> str:
    if isinstance(answer, str):
        return answer
    try:
        return service.write(answer)
    except Exception:
        logger.exception("Line %s of a batch for %s", number, service.world)
        return _refuse_line(number, FAILED)


def _refuse_line(number: int, sentence: str) -> str:
    return as_json({"line": number, "detail": f"Line {number}: {sentence}"})


def read_object(body: bytes) -> dict[str, Any]:
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
