"""The lines of a file or a pipe, each answered as it comes: plain texts, or JSON lines."""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path

from annotations.language.texts import Refusal, decode
from parser_service.serving.answerer import Answerer
from parser_service.serving.lines import LineAnswer, answer_some, read_object, utterance_in
from parser_service.serving.preparing import require_utterance

AT_ONCE = 65_536  # bytes that are read where so many are there
MOST_OF_A_LINE = 1_000_000  # bytes that are kept; a longer line is refused in any case
_BYTE_ORDER_MARK = "\ufeff"


def require_utf8(path: Path) -> None:
    """Read a file to its end, unless it is a pipe. Raises LanguageError where it is not UTF-8, and OSError."""
    if path.exists() and not (path.is_file() or path.is_dir()):
        return
    data = path.read_bytes()
    try:
        data.decode()
    except UnicodeDecodeError:
        decode(data, path.name)  # it says where, and what would read it


def answer_file(
    answerer: Answerer, file: io.BufferedReader, beam: int
) -> Iterator[list[LineAnswer]]:
    """Yield the answers to the lines of ``file`` in their order, as many at a time as the parser reads together.

    What has arrived of a pipe is answered without waiting for more. A blank line has no candidates.
    """
    together = answerer.lines_together
    for lines in arriving_lines(file):
        for at in range(0, len(lines), together):
            yield answer_some(answerer, lines[at : at + together], beam, read_line)


def arriving_lines(file: io.BufferedReader) -> Iterator[list[tuple[int, bytes]]]:
    """Yield the lines of ``file`` that have arrived, numbered from 1. The last one need not be ended."""
    number, begun = 1, b""
    while piece := file.read1(AT_ONCE):
        first, *others = piece.split(b"\n")
        begun += first[: MOST_OF_A_LINE - len(begun)]
        if others:
            ended = [begun, *others[:-1]]
            yield list(enumerate(ended, number))
            number, begun = number + len(ended), others[-1]
    if begun:
        yield [(number, begun)]


def read_line(line: bytes) -> str:
    """Return the utterance of a line, a JSON object or a plain text; empty for a blank one. Raises Refusal."""
    try:
        text = line.decode().removeprefix(_BYTE_ORDER_MARK).strip()
    except UnicodeDecodeError as error:
        raise Refusal(
            f"From byte {error.start + 1} on this is not UTF-8. Send UTF-8.", "not_utf8"
        ) from error
    value = utterance_in(read_object(text)) if text.startswith("{") else text
    try:
        return require_utterance(value)
    except Refusal as error:
        if isinstance(value, str) and error.code == "no_utterance":
            return ""
        raise
