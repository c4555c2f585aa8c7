"""A client of GPSR Workbench: parse commands, talk about them, export examples. Standard library only."""

from __future__ import annotations

from gpsr_client.client import Workbench
from gpsr_client.dialogue import Dialogue, SlotQuestion
from gpsr_client.errors import Away, Refused, WorkbenchError
from gpsr_client.responses import (
    Candidate,
    HeardChange,
    Interleaving,
    JointPlan,
    Note,
    OpenArgument,
    OpenSlot,
    Parse,
    Plan,
    PlanProblem,
    Reason,
    SaidWords,
    Step,
    TaskPlan,
    TaskStep,
    Unresolved,
)

__all__ = [
    "Away",
    "Candidate",
    "Dialogue",
    "HeardChange",
    "Interleaving",
    "JointPlan",
    "Note",
    "OpenArgument",
    "OpenSlot",
    "Parse",
    "Plan",
    "PlanProblem",
    "Reason",
    "Refused",
    "SaidWords",
    "SlotQuestion",
    "Step",
    "TaskPlan",
    "TaskStep",
    "Unresolved",
    "Workbench",
    "WorkbenchError",
]
