"""Hear commands, talk until one is agreed on, and hand over its plan. Knows nothing of ROS."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Protocol

from gpsr_client import Away, Dialogue, WorkbenchError

SORRY_AWAY = "I cannot understand commands right now. Please try again in a moment."


class Talker(Protocol):
    """What a desk needs of a workbench."""

    def dialogue(self, utterance: str) -> Dialogue: ...


class CommandDesk:
    """Takes what people say, one text after another.

    Args:
        workbench: understands commands.
        say: speaks a sentence.
        act: gets a plan as JSON when a person has agreed to it.
    """

    def __init__(
        self, workbench: Talker, say: Callable[[str], None], act: Callable[[str], None]
    ) -> None:
        self._workbench = workbench
        self._say = say
        self._act = act
        self._dialogue: Dialogue | None = None

    def hear(self, text: str) -> None:
        """Take a text: a new command, or the answer to what was asked last."""
        if not text.strip():
            return
        try:
            tell = self._dialogue.answer if self._dialogue else self._workbench.dialogue
            dialogue = tell(text)
        except Away:
            self._say(SORRY_AWAY)
            return
        except WorkbenchError as error:
            self._dialogue = None
            self._say(f"That did not work. {error}")
            return
        self._dialogue = None if dialogue.is_over else dialogue
        self._say(dialogue.prompt)
        if dialogue.is_agreed:
            self._act(json.dumps(dialogue.raw["plan"]))
