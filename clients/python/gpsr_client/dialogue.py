"""A dialogue about a command, held by the workbench: ask what it asks, answer, act."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any
from uuid import uuid4

from gpsr_client.responses import Plan, TaskPlan
from gpsr_client.transport import Transport


@dataclass(frozen=True)
class SlotQuestion:
    """What a dialogue asks for: a class of entities, and what there is to choose from."""

    entity_class: str
    choices: tuple[str, ...]
    likely: str | None
    phrases: tuple[str, ...]


class Dialogue:
    """A dialogue as the workbench last told it. ``prompt`` is what the robot says next."""

    def __init__(self, transport: Transport, path: str, value: dict[str, Any]) -> None:
        self._transport = transport
        self._path = path
        self.raw = value

    def __repr__(self) -> str:
        return f"Dialogue({self.id}, {self.phase!r}, {self.prompt!r})"

    @property
    def id(self) -> int:
        return int(self.raw["id"])

    @property
    def phase(self) -> str:
        """``checking``, ``asking``, ``learning``, ``confirming``, ``rephrasing``, ``done`` or ``cancelled``."""
        return str(self.raw["phase"])

    @property
    def prompt(self) -> str:
        return str(self.raw["prompt"])

    @property
    def is_over(self) -> bool:
        return bool(self.raw["is_over"])

    @property
    def is_agreed(self) -> bool:
        """Whether the person has agreed to the whole command."""
        return self.phase == "done"

    @property
    def may_act(self) -> bool:
        """Whether the robot may carry out the task plan, and can."""
        return self.is_agreed and self.task_plan.is_executable

    @property
    def grounded(self) -> str:
        """The form with the entities so far."""
        return str(self.raw["grounded"])

    @property
    def english(self) -> str:
        return str(self.raw["english"])

    @property
    def plan(self) -> Plan:
        return Plan.from_json(self.raw["plan"])

    @property
    def task_plan(self) -> TaskPlan:
        """The same in the primitives of the robot."""
        return TaskPlan.from_json(self.raw["task_plan"])

    @property
    def spoken(self) -> str:
        """What the robot says before it begins."""
        return str(self.raw["spoken"])

    @property
    def asked(self) -> SlotQuestion | None:
        """What it asks for; None where it waits for a yes, for another utterance or for nothing."""
        asked = self.raw["asked"]
        if asked is None:
            return None
        return SlotQuestion(
            asked["entity_class"],
            tuple(asked["choices"]),
            asked["likely"],
            tuple(asked["phrases"]),
        )

    def answer(self, text: str) -> Dialogue:
        """Answer what it asks, and return the dialogue after that.

        Raises Refused with status 409 if somebody else has answered in the meantime.
        """
        body = {"answer": text, "version": self.raw["version"]}
        value = self._transport.post(f"{self._path}{self.id}/answer/", body, uuid4().hex)
        return Dialogue(self._transport, self._path, value)
