"""Hear commands, do what is sure, ask about what is not, and hand over plans. Knows nothing of ROS."""

from __future__ import annotations

import json
from collections import deque
from collections.abc import Callable
from typing import Any, Protocol

from gpsr_client import Away, Dialogue, Parse, WorkbenchError

SORRY_AWAY = "I cannot understand commands right now. Please try again in a moment."
WILL = "I will do it."
WILL_NOT = "I will not do it."
YES = frozenset(("yes", "yeah", "yep", "sure", "ok", "okay", "correct", "right", "please do"))
NO = frozenset(("no", "nope", "stop", "cancel", "don't", "wrong"))


class Talker(Protocol):
    """What a desk needs of a workbench."""

    def parse(self, utterance: str) -> Parse: ...

    def dialogue(self, utterance: str) -> Dialogue: ...


class CommandDesk:
    """Takes what people say, one text after another, and does with each what the decision of its answer says.

    Args:
        workbench: understands commands.
        say: speaks a sentence.
        act: gets a plan in the robot's primitives, as JSON, that may be carried out. It holds one command, or all
            commands of an utterance.
    """

    def __init__(
        self, workbench: Talker, say: Callable[[str], None], act: Callable[[str], None]
    ) -> None:
        self._workbench = workbench
        self._say = say
        self._act = act
        self._dialogue: Dialogue | None = None
        self._confirmed: Parse | None = None  # waits for a yes
        self._waiting: deque[Parse] = deque()  # commands of the same utterance

    def hear(self, text: str) -> None:
        """Take a text: a new command, or the answer to what was asked last."""
        if not text.strip():
            return
        try:
            self._take(text)
        except Away:
            self._say(SORRY_AWAY)
        except WorkbenchError as error:
            self._forget()
            self._say(f"That did not work. {error}")

    def _take(self, text: str) -> None:
        if self._dialogue:
            self._follow(self._dialogue.answer(text))
        elif self._confirmed:
            self._take_yes_or_no(self._confirmed, text)
        else:
            self._waiting.append(self._workbench.parse(text))
        while self._waiting and not self._dialogue and not self._confirmed:
            self._decide(self._waiting.popleft())

    def _take_yes_or_no(self, parse: Parse, text: str) -> None:
        """Carry out what waits for a yes, or leave it; anything else is a new command."""
        reply = text.strip().strip(".,!").casefold()
        if reply in YES or reply in NO:
            self._confirmed = None
            self._say(WILL if reply in YES else WILL_NOT)
            if reply in YES:
                self._carry_out(_plan_of(parse))
        else:
            answer = self._workbench.parse(text)
            self._forget()
            self._waiting.append(answer)

    def _decide(self, parse: Parse) -> None:
        if parse.several and not (parse.may_act and parse.joint_plan):
            self._waiting.extendleft(reversed(parse.several))  # each by its own decision
        elif parse.may_act:
            self._say(parse.spoken)
            self._carry_out(
                parse.joint_plan.raw["joint_plan"] if parse.joint_plan else _plan_of(parse)
            )
        elif parse.decision == "confirm":
            self._confirmed = parse
            self._say(parse.spoken)
        elif parse.decision == "ask":
            self._follow(self._workbench.dialogue(parse.utterance))
        else:
            near = f" You can say: {parse.nearest[0]}." if parse.nearest else ""
            self._say(f"{parse.spoken}{near}")

    def _follow(self, dialogue: Dialogue) -> None:
        self._dialogue = None if dialogue.is_over else dialogue
        self._say(dialogue.prompt)
        if dialogue.is_agreed:
            self._carry_out(dialogue.raw["task_plan"])

    def _carry_out(self, plan: dict[str, Any]) -> None:
        """Hand over what may be done, where nothing stands in the way of it; else ask what is open."""
        if plan["is_executable"]:
            self._act(json.dumps(plan))
        else:
            questions = [gap["question"] for each in plan["unresolved"] for gap in each["open"]]
            questions += [each["message"] for each in plan["problems"]]
            self._say(questions[0])

    def _forget(self) -> None:
        self._dialogue = self._confirmed = None
        self._waiting.clear()


def _plan_of(parse: Parse) -> dict[str, Any]:
    """Return the best plan in primitives. There is one wherever the decision is to act or to confirm."""
    plan: dict[str, Any] = parse.raw["candidates"][0]["task_plan"]
    return plan
