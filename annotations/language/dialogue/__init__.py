"""Talk with a person until a command has nothing open: a pure state machine."""

from __future__ import annotations

from annotations.language.dialogue.machine import (
    ATTEMPTS,
    PATIENCE,
    DialogueManager,
    DialogueState,
    Offer,
    Phase,
    progress,
    shall_i,
)
from annotations.language.dialogue.reactions import Reaction, reaction_of

__all__ = [
    "ATTEMPTS",
    "PATIENCE",
    "DialogueManager",
    "DialogueState",
    "Offer",
    "Phase",
    "Reaction",
    "progress",
    "reaction_of",
    "shall_i",
]
