"""What people decided about rows that a file brings again: they deleted them, or changed what identifies them.

An import does not undo this unless it is asked to: what is deleted stays away, and a row that was moved
or renamed is the same row.
"""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from typing import Any, TypeVar

from annotations.models import Editable, World
from annotations.models.editing import Placed
from annotations.rows.history import DELETED, OF_IMPORT, history_of, keys_changed_by_people
from annotations.rows.synchronise import RowPlan, batches

Row = TypeVar("Row", bound=Editable)


@dataclass(frozen=True, slots=True)
class RowDecision:
    """``last`` is the newest entry in the history of a row that people have deleted or changed."""

    last: Any

    @property
    def is_deletion(self) -> bool:
        return bool(self.last.history_type == DELETED)

    def say(self) -> str:
        """Return who did what and when, as a part of a sentence."""
        who, day = self.last.history_user or "somebody", f"{self.last.history_date:%Y-%m-%d}"
        if self.is_deletion:
            return f"deleted by {who} on {day}"
        return f"kept as {who} has it since {day}: {self.last.instance}"


class RowDecisions:
    """The decisions about the rows of one model, by each key that the row had in its history."""

    def __init__(self, model: type[Row], world: World, key: Callable[[Row], Hashable]) -> None:
        self._by_key: dict[Hashable, deque[RowDecision]] = defaultdict(deque)
        touched = keys_changed_by_people(model, world)
        entries: dict[int, list[Any]] = defaultdict(list)
        for some in batches(sorted(touched)):
            rows = history_of(model).filter(id__in=some).select_related("history_user")
            for entry in rows.order_by("history_id"):
                entries[entry.id].append(entry)
        for versions in entries.values():
            decision = RowDecision(versions[-1])
            if decision.is_deletion and decision.last.history_change_reason == OF_IMPORT:
                continue
            known_as = {key(version.instance) for version in versions}
            if not decision.is_deletion:
                known_as.discard(key(decision.last.instance))
            for name in known_as:
                self._by_key[name].append(decision)

    def take(self, key: Hashable) -> RowDecision | None:
        """Return a decision about a row that is or was known as ``key``, each of them once."""
        decisions = self._by_key.get(key)
        return decisions.popleft() if decisions else None


def respect(
    plan: RowPlan[Row], world: World, key: Callable[[Row], Hashable], brings_back: bool
) -> RowPlan[Row]:
    """Remove from the new rows of ``plan`` what people have deleted, moved or renamed.

    ``brings_back`` lets a file restore what was deleted. Returns the plan.
    """
    if not plan.new:
        return plan
    decisions = RowDecisions(plan.model, world, key)
    unmatched = {row.pk: row for row in (*plan.removed, *plan.kept)}
    new, plan.new = plan.new, []
    for target in new:
        decision = decisions.take(key(target))
        if decision is None:
            plan.new.append(target)
        elif not decision.is_deletion:
            plan.left_out.append((target, decision.say()))
            if row := unmatched.get(decision.last.id):
                _put_in_place(plan, row, target)
        elif brings_back:
            target.pk, target.version = decision.last.id, decision.last.version + 1
            plan.restored.append(target)
        else:
            plan.left_out.append((target, decision.say()))
    return plan


def _put_in_place(plan: RowPlan[Row], row: Row, target: Row) -> None:
    """Let ``row`` stay, as people have it, where the file has ``target``."""
    plan.removed = [each for each in plan.removed if each.pk != row.pk]
    plan.moved = [each for each in plan.moved if each.pk != row.pk]
    assert isinstance(row, Placed) and isinstance(target, Placed)
    if row.position != target.position:
        row.position = target.position
        plan.moved.append(row)
