"""What is asked of a robot: several commands at once, commands under a condition, requests that are none, and how well a
form fits what was said."""

from __future__ import annotations

from annotations.language.requests.cutting import MOST_COMMANDS, Judge, cut_commands
from annotations.language.requests.fitting import (
    Exchange,
    Fit,
    Left,
    LeftOut,
    best_fitting,
    exchange,
    fit,
)
from annotations.language.requests.qualifying import is_qualified, says_number
from annotations.language.requests.request_kinds import OtherRequest, other_requests
from annotations.language.requests.word_use import WordUse

__all__ = [
    "MOST_COMMANDS",
    "Exchange",
    "Fit",
    "Judge",
    "Left",
    "LeftOut",
    "OtherRequest",
    "WordUse",
    "best_fitting",
    "cut_commands",
    "exchange",
    "fit",
    "is_qualified",
    "other_requests",
    "says_number",
]
