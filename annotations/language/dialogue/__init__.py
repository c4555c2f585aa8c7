"""Talk with a person until a command has nothing open: a pure state machine."""

from __future__ import annotations

from annotations.language.dialogue.answers import Reaction, reaction_of
from annotations.language.dialogue.machine import ATTEMPTS, PATIENCE, Dialogue, progress
from annotations.language.dialogue.states import Offer, Phase, State

__all__ = [
    "ATTEMPTS",
    "PATIENCE",
    "Dialogue",
    "Offer",
    "Phase",
    "Reaction",
    "State",
    "progress",
    "reaction_of",
]
