"""What is asked of a robot: several commands at once, commands under a condition, and requests that are none.

``fit`` compares a form with what was said, whichever parser gave it; ``objections`` and ``stopped_by`` need no form.
"""

from __future__ import annotations

from annotations.language.requests.alternatives import best_alternative
from annotations.language.requests.cutting import (
    MOST_COMMANDS,
    Islands,
    Judge,
    Piece,
    cut,
    cut_at_joints,
    sentences,
)
from annotations.language.requests.fitting import (
    Exchange,
    Fit,
    Left,
    LeftOut,
    best_fitting,
    exchange,
    fit,
)
from annotations.language.requests.qualifying import (
    Objection,
    Qualified,
    is_qualified,
    objections,
    says_number,
)
from annotations.language.requests.request_kinds import OtherRequest, other_requests
from annotations.language.requests.stopping import (
    UNKNOWN_NAME,
    UNKNOWN_WORD,
    NearCommands,
    StoppingWords,
    with_entities,
)
from annotations.language.requests.word_use import WordUse

__all__ = [
    "MOST_COMMANDS",
    "UNKNOWN_NAME",
    "UNKNOWN_WORD",
    "Exchange",
    "Fit",
    "Islands",
    "Judge",
    "Left",
    "LeftOut",
    "NearCommands",
    "Objection",
    "OtherRequest",
    "Piece",
    "Qualified",
    "StoppingWords",
    "WordUse",
    "best_alternative",
    "best_fitting",
    "cut",
    "cut_at_joints",
    "exchange",
    "fit",
    "is_qualified",
    "objections",
    "other_requests",
    "says_number",
    "sentences",
    "with_entities",
]
