"""Put the problems of a report together that are of one kind, so that a person reads each kind once."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

# A quoted text is one word, whatever it says.
WORDS = re.compile(r'"[^"]*"|“[^“”]*”|\S+')
# What names one row or counts something: it differs from problem to problem of one kind.
PARTICULAR = re.compile(r'["“$<{0-9]')
ANYTHING = "…"
MOST_SHOWN = 50  # of one kind


@dataclass(frozen=True, slots=True)
class ProblemGroup:
    """Problems of one kind. ``title`` is what their messages have in common, or else what to do about them."""

    severity: str
    title: str
    hint: str
    problems: Sequence[Mapping[str, Any]]

    @property
    def has_one_message(self) -> bool:
        """Whether all of them say the same, so that the title says it."""
        return ANYTHING not in self.title.split()

    @property
    def has_one_hint(self) -> bool:
        return ANYTHING not in self.hint.split()

    @property
    def count(self) -> int:
        return len(self.problems)

    @property
    def shown(self) -> Sequence[Mapping[str, Any]]:
        return self.problems[:MOST_SHOWN]

    @property
    def n_left_out(self) -> int:
        return max(0, self.count - MOST_SHOWN)


def group_problems(problems: Sequence[Mapping[str, Any]]) -> list[ProblemGroup]:
    """Return the problems by kind, each kind where its first problem stands.

    Two are of one kind where the same is to be done about them: their hints are equal but for what names a row.
    Without a hint their messages are.
    """
    groups: dict[tuple[str, str], list[Mapping[str, Any]]] = {}
    for each in problems:
        kind = _without_particulars(each["hint"] or each["message"])
        groups.setdefault((each["severity"], kind), []).append(each)
    return [_group(severity, some) for (severity, _), some in groups.items()]


def _group(severity: str, problems: Sequence[Mapping[str, Any]]) -> ProblemGroup:
    hint = in_common([each["hint"] for each in problems])
    title = in_common([each["message"] for each in problems])
    if title == ANYTHING and hint:
        title, hint = f"{ANYTHING} {hint}", ""
    return ProblemGroup(severity, title, hint, problems)


def in_common(texts: Sequence[str]) -> str:
    """Return the words that all ``texts`` have at the same places, from the start or from the end; … for the others."""
    first, *others = (WORDS.findall(text) for text in texts)
    words = first
    for other in others:
        if len(other) == len(words):
            words = [a if a == b else ANYTHING for a, b in zip(words, other, strict=True)]
            continue
        head = _same_at_start(words, other)
        most_left = min(len(words), len(other)) - head
        tail = min(most_left, _same_at_start(words[::-1], other[::-1]))
        words = [*words[:head], ANYTHING, *words[len(words) - tail :]]
    kept = (
        word
        for at, word in enumerate(words)
        if word != ANYTHING or at == 0 or words[at - 1] != ANYTHING
    )
    return " ".join(kept)


def _same_at_start(first: Sequence[str], second: Sequence[str]) -> int:
    count = 0
    for a, b in zip(first, second, strict=False):
        if a != b:
            break
        count += 1
    return count


def _without_particulars(text: str) -> str:
    return " ".join(ANYTHING if PARTICULAR.search(word) else word for word in WORDS.findall(text))
