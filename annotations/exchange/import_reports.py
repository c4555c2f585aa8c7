"""What an import read and did."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from annotations.exchange.import_plans import RowTexts
from annotations.language.texts import Problem
from annotations.rows.stored_problems import as_json
from annotations.rows.synchronise import Changes


class Refusable:
    """What is refused whole where one of its ``problems`` is an error."""

    __slots__ = ()

    problems: tuple[Problem, ...]

    @property
    def errors(self) -> tuple[Problem, ...]:
        return tuple(problem for problem in self.problems if problem.is_error)

    @property
    def is_refused(self) -> bool:
        return bool(self.errors)


@dataclass(frozen=True, slots=True)
class ImportReport(Refusable):
    """``productions`` counts lines by file, ``templates`` by task category, ``entities`` by class.

    With an error among the ``problems`` the import was refused whole: nothing was stored, and the
    counts say what could be read. Where there are ``removals`` that were not allowed, nothing was
    stored either. ``left_out`` are lines that people have deleted, moved or renamed here.
    """

    world: str
    productions: Mapping[str, int] = field(default_factory=dict)
    templates: Mapping[str, int] = field(default_factory=dict)
    entities: Mapping[str, int] = field(default_factory=dict)
    predicates: int = 0
    problems: tuple[Problem, ...] = ()
    changes: Changes = field(default_factory=Changes)
    removals: RowTexts = field(default_factory=RowTexts)
    left_out: RowTexts = field(default_factory=RowTexts)
    is_waiting: bool = False

    def as_json(self) -> dict[str, Any]:
        return {
            "world": self.world,
            "productions": dict(self.productions),
            "templates": dict(self.templates),
            "entities": dict(self.entities),
            "predicates": self.predicates,
            "problems": [as_json(problem) for problem in self.problems],
            "changes": self.changes.as_json(),
            "removals": self.removals.as_json(),
            "left_out": self.left_out.as_json(),
            "is_waiting": self.is_waiting,
        }


@dataclass(frozen=True, slots=True)
class PairsReport(Refusable):
    """``counts`` are pairs by criterion, source and part; ``splits`` their names by criterion.

    With an error among the ``problems`` nothing was stored. ``left_out`` are paraphrases that people have
    deleted or changed here, and who did.
    """

    world: str
    counts: Mapping[str, Mapping[str, Mapping[str, int]]] = field(default_factory=dict)
    splits: Mapping[str, str] = field(default_factory=dict)
    paraphrases: int = 0
    added: int = 0
    left_out: tuple[str, ...] = ()
    problems: tuple[Problem, ...] = ()

    def as_json(self) -> dict[str, Any]:
        return {
            "world": self.world,
            "counts": self.counts,
            "splits": self.splits,
            "paraphrases": self.paraphrases,
            "problems": [as_json(problem) for problem in self.problems],
            "changes": {"added": self.added},
            "left_out": {"paraphrases": list(self.left_out)},
        }
