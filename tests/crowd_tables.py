"""Tables of results as crowd markets give them."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence

# A prompt, its form with class tokens, its form with entities.
GO = ("go to the study", '( go " <room> " )', '( go " study " )')
FIND = ("find the apple", '( find " <object> " )', '( find " apple " )')
PROMPTS = (GO, FIND)


def results(rows: Iterable[Mapping[str, str]], prompts: Sequence[Sequence[str]] = PROMPTS) -> bytes:
    """Return a table with a row for each of ``rows``: its cells by name, over those of an approved assignment.

    ``1`` is short for ``Answer.utterance1``; ``free`` for ``Answer.custom1``, ``worker`` for ``WorkerId``.
    """
    rows = list(rows)
    numbers = range(1, len(prompts) + 1)
    inputs = {
        f"Input.{name}{number}": text
        for number, prompt in zip(numbers, prompts, strict=True)
        for name, text in zip(("command", "parse", "parse_ground"), prompt, strict=True)
    }
    short = {str(number): f"Answer.utterance{number}" for number in numbers}
    short |= {"free": "Answer.custom1", "worker": "WorkerId"}
    usual = {"WorkerId": "W1", "AssignmentStatus": "Approved", "WorkTimeInSeconds": "120"}
    usual |= inputs | dict.fromkeys([*short.values(), "Answer.comment"], "") | {"WorkerId": "W1"}
    if any("AssignmentId" in row for row in rows):
        usual["AssignmentId"] = ""
    written = io.StringIO()
    table = csv.DictWriter(written, list(usual), lineterminator="\r\n")
    table.writeheader()
    for row in rows:
        table.writerow({**usual, **{short.get(name, name): text for name, text in row.items()}})
    return written.getvalue().encode()
