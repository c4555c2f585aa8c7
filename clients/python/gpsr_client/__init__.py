"""A client of GPSR Workbench: parse commands, talk about them, export examples. Standard library only."""

from __future__ import annotations

from gpsr_client.answers import Candidate, OpenSlot, Parse, Plan, PlanProblem, Step
from gpsr_client.client import Workbench
from gpsr_client.dialogue import Asked, Dialogue
from gpsr_client.errors import Away, Refused, WorkbenchError

__all__ = [
    "Asked",
    "Away",
    "Candidate",
    "Dialogue",
    "OpenSlot",
    "Parse",
    "Plan",
    "PlanProblem",
    "Refused",
    "Step",
    "Workbench",
    "WorkbenchError",
]
