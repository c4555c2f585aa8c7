"""Prepare what a change would do to commands, templates and splits for pages."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from annotations.generation.world_consequences import WorldConsequences
from annotations.language.texts import say_count

MOST_SHOWN = 8


@dataclass(frozen=True)
class ChangeGroup:
    """The rows that change in one way: a sentence, the first rows, and how many are left out."""

    kind: str
    sentence: str
    rows: tuple[Any, ...]
    left_out: int


def groups_of(expected: WorldConsequences) -> list[ChangeGroup]:
    """Group what would change by kind, with the first rows of each."""
    changes = expected.changes
    name: Any = expected.templates.get
    kinds = (
        ("covered", "newly covered", changes.covered_in_grammar),
        ("outside", "that the grammar does not make", changes.covered_outside),
        ("changed", "with another form", changes.changed),
        ("lost", "without a form from then on", changes.lost),
        ("conflicts", "in conflict: the later template wins", changes.conflicts),
        ("resolved", "no longer in conflict", changes.conflicts_gone),
        (
            "duplicates",
            "that say the same as an earlier one",
            [(name(each.template), name(each.earlier)) for each in changes.duplicates],
        ),
        (
            "shadowed",
            "whose commands are all taken by another",
            [(name(each.template), name(each.by)) for each in changes.shadowed],
        ),
        ("left_out", "left out", changes.left_out),
        ("splits", "whose pairs no longer agree with the world", expected.splits.splits),
    )
    nouns = {
        "duplicates": "template",
        "shadowed": "template",
        "left_out": "template",
        "splits": "split",
    }
    return [
        ChangeGroup(
            kind,
            f"{say_count(len(rows), nouns.get(kind, 'command'))} {rest}",
            tuple(rows[:MOST_SHOWN]),
            max(0, len(rows) - MOST_SHOWN),
        )
        for kind, rest, rows in kinds
        if rows
    ]
