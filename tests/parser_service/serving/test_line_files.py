"""Lines as they arrive on a pipe, and what each of them asks."""

from __future__ import annotations

import io
import os

import pytest

from annotations.language.texts.errors import LanguageError, Refusal
from parser_service.serving.line_files import (
    AT_ONCE,
    MOST_OF_A_LINE,
    arriving_lines,
    read_line,
    require_utf8,
)


def lines_in(data: bytes) -> list[tuple[int, bytes]]:
    return [each for some in arriving_lines(io.BytesIO(data)) for each in some]


@pytest.mark.parametrize(
    ("data", "lines"),
    [
        (b"", []),
        (b"a", [(1, b"a")]),
        (b"a\n", [(1, b"a")]),
        (b"a\n\n", [(1, b"a"), (2, b"")]),
        (b"\na\r\nb", [(1, b""), (2, b"a\r"), (3, b"b")]),
    ],
)
def test_no_line_is_lost_or_added(data, lines):
    assert lines_in(data) == lines


def test_lines_that_arrive_in_pieces_are_whole():
    written = [bytes([97 + number % 26]) * (number * 37 % 900) for number in range(2_000)]
    read = lines_in(b"\n".join(written) + b"\n")
    assert [line for _, line in read] == written
    assert [number for number, _ in read] == list(range(1, 2_001))


def test_a_line_without_an_end_does_not_fill_the_memory():
    (first, second) = lines_in(b"x" * (MOST_OF_A_LINE + 3 * AT_ONCE) + b"\nnext")
    assert len(first[1]) == MOST_OF_A_LINE
    assert second == (2, b"next")


def test_a_pipe_is_not_waited_for():
    reading, writing = os.pipe()
    with open(reading, "rb") as pipe, open(writing, "wb", buffering=0) as sender:
        lines = arriving_lines(pipe)
        sender.write(b"first\nsec")
        assert next(lines) == [(1, b"first")]
        sender.write(b"ond\nthird\n")
        assert next(lines) == [(2, b"second"), (3, b"third")]


@pytest.mark.parametrize(
    ("line", "utterance"),
    [
        (b"  go to the kitchen \r", "go to the kitchen"),
        (b'{"utterance": "go", "command": "walk"}', "go"),
        (b'{"command": "walk", "kinds": []}', "walk"),
        (b'\xef\xbb\xbf{"command": "walk"}', "walk"),
        (b"", ""),
        (b" \t\r", ""),
        ("\u200b".encode(), ""),
        (b'{"utterance": " "}', ""),
    ],
)
def test_a_line_is_a_text_or_a_json_object(line, utterance):
    assert read_line(line) == utterance


@pytest.mark.parametrize(
    ("line", "code"),
    [
        (b"{go", "not_a_json_object"),
        (b"{}", "no_utterance"),
        (b'{"utterance": null}', "no_utterance"),
        (b'{"command": 7}', "no_utterance"),
        (b"x" * 501, "utterance_too_long"),
        (b"\xff", "not_utf8"),
        (b"a\0b", "utterance_unwritable"),
        (b'{"utterance": "\\ud83d"}', "utterance_unwritable"),
    ],
)
def test_what_is_wrong_with_a_line_has_a_code(line, code):
    with pytest.raises(Refusal) as refused:
        read_line(line)
    assert refused.value.code == code


def test_a_file_that_is_not_utf8_is_refused_at_its_byte(tmp_path):
    file = tmp_path / "lines.txt"
    file.write_bytes(b"tea\ncaf\xe9\n")
    with pytest.raises(LanguageError) as refused:
        require_utf8(file)
    assert (refused.value.source, refused.value.line, refused.value.column) == ("lines.txt", 2, 4)
    file.write_text("tea\n\ncafé\n", encoding="utf-8")
    require_utf8(file)
    for missing in (tmp_path, tmp_path / "no.txt"):
        with pytest.raises(OSError):
            require_utf8(missing)
