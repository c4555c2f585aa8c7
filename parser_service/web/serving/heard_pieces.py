"""An utterance in pieces, as pages show what was heard: names of entities, and what was heard otherwise than said."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

# Kind of a change → why it was made.
KINDS = {
    "filler": "a filler",
    "repeated": "said twice",
    "repair": "taken back",
    "courtesy": "courtesy",
    "contraction": "a contraction",
    "article": "an article",
    "joined": "one word",
    "split": "two words",
    "number": "a number",
    "sound": "sounds like it",
    "spelling": "a near spelling",
    "inflection": "singular or plural",
    "alias": "another word for it",
    "reference": "somebody or something said before",
}


@dataclass(frozen=True, slots=True)
class HeardPiece:
    """A stretch of an utterance. ``entity_class`` and ``value`` are of the entity that it names, both empty where it
    names none. ``why`` says why ``heard`` was heard in its place; empty where nothing was changed."""

    text: str
    entity_class: str = ""
    value: str = ""
    heard: str = ""
    why: str = ""


def heard_pieces(answer: Mapping[str, Any]) -> list[HeardPiece]:
    """Return the utterance of an answer (docs/reference/parse-server.md), piece by piece.

    Where an entity is named by words that were heard otherwise, the change is shown.
    """
    utterance = answer["utterance"]
    marked = [(each["start"], each["end"], 0, each) for each in answer["heard"]]
    marked += [(each["start"], each["end"], 1, each) for each in answer["spans"]]
    return list(_cut(utterance, sorted(marked, key=lambda each: each[:3])))


def _cut(
    utterance: str, marked: list[tuple[int, int, int, Mapping[str, Any]]]
) -> Iterator[HeardPiece]:
    changed = [(start, end) for start, end, is_name, _ in marked if not is_name]
    reached = 0
    for start, end, is_name, each in marked:
        is_changed = any(first < end and start < last for first, last in changed)
        if start < reached or (is_name and is_changed):
            continue
        if start > reached:
            yield HeardPiece(utterance[reached:start])
        said, reached = utterance[start:end], end
        if is_name:
            yield HeardPiece(said, each["entity_class"], each["value"])
        else:
            yield HeardPiece(said, heard=each["heard"], why=KINDS.get(each["kind"], each["kind"]))
    if reached < len(utterance):
        yield HeardPiece(utterance[reached:])
