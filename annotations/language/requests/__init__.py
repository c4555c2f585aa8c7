"""What is asked of a robot: several commands at once, commands under a condition, and requests that are none."""

from __future__ import annotations

from annotations.language.requests.cutting import (
    MOST_COMMANDS,
    Islands,
    Judge,
    Piece,
    cut,
    cut_at_joints,
)
from annotations.language.requests.qualifying import is_qualified, says_number
from annotations.language.requests.request_kinds import OtherRequest, other_requests

__all__ = [
    "MOST_COMMANDS",
    "Islands",
    "Judge",
    "OtherRequest",
    "Piece",
    "cut",
    "cut_at_joints",
    "is_qualified",
    "other_requests",
    "says_number",
]
