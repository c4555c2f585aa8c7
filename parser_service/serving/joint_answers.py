"""Several commands at once: what the parser understands of each, and one plan that does them all."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from annotations.language.forms import UNKNOWN, Form, read_form
from annotations.language.grounding import Slot
from annotations.language.plans import (
    MOST_COMMANDS,
    Distances,
    JointPlan,
    TaskPlan,
    TaskValue,
    TooManyCommands,
    join,
    spoken,
)
from annotations.language.texts import Refusal
from annotations.models import World
from parser_service.serving.parse_answers import task_plan_of
from parser_service.serving.parser_client import client
from parser_service.serving.preparing import WorldLanguage, require_utterance


@dataclass(frozen=True, slots=True)
class UnderstoodCommand:
    """One of the commands: its form with entities, the task plan of it alone, and how sure the answer is."""

    utterance: str
    is_unknown: bool
    grounded: str
    english: str
    task_plan: TaskPlan
    decision: str
    sureness: str
    probability: float | None

    def as_json(self) -> dict[str, Any]:
        return {
            "utterance": self.utterance,
            "is_unknown": self.is_unknown,
            "grounded": self.grounded,
            "english": self.english,
            "task_plan": self.task_plan.as_json(),
            "spoken": spoken(self.task_plan),
            "decision": self.decision,
            "sureness": self.sureness,
            "probability": self.probability,
        }


@dataclass(frozen=True, slots=True)
class JointAnswer:
    """The commands in the order in which they were said, and one plan of all."""

    commands: tuple[UnderstoodCommand, ...]
    plan: JointPlan

    @property
    def spoken(self) -> str:
        return self.plan.spoken

    def as_json(self) -> dict[str, Any]:
        """Return plain values, as REST answers them (docs/reference/recipes.md)."""
        return {
            "commands": [each.as_json() for each in self.commands],
            "joint_plan": self.plan.as_json(),
            "spoken": self.spoken,
        }


def commands_in(world: World, utterance: str, run: int | None = None) -> tuple[str, ...]:
    """Return the commands of one utterance, as what answers in the world cuts it; none of a blank one.

    Raises:
        TooManyCommands: there are more than ``MOST_COMMANDS``.
        ParserAway, ParserRefused: as ``ParserClient.parse``.
    """
    if not any(map(str.isalnum, utterance)):
        return ()
    several = client().parse(world.name, utterance, beam=1, run=run)["several"]
    commands = tuple(each["utterance"] for each in several) or (utterance,)
    _require_few(commands)
    return commands


def plan_together(
    world: World,
    utterances: Sequence[str],
    run: int | None = None,
    distances: Distances | None = None,
) -> JointAnswer:
    """Ask the promoted parser of a world, or that of ``run``, about each command, and plan all of them together.

    Raises:
        Refusal: there is none or too many, or one of them is no utterance.
        ParserAway, ParserRefused: as ``ParserClient.parse``.
    """
    texts = [require_utterance(each) for each in utterances]
    if not texts:
        raise Refusal("There is no command: send one to three.", "no_utterance")
    _require_few(texts)
    language = WorldLanguage.of(world)
    ask = client()
    commands = understand((ask.parse(world.name, text, run=run) for text in texts), language)
    plans = [each.task_plan for each in commands]
    return JointAnswer(commands, join(plans, language.recipes, distances, texts))


def understand(
    answers: Iterable[Mapping[str, Any]], language: WorldLanguage
) -> tuple[UnderstoodCommand, ...]:
    """Return commands from the JSON of their answers, in the order in which they were said.

    After "go to the bedroom" a command that looks for something without a place looks there.
    """
    commands: list[UnderstoodCommand] = []
    for answer in answers:
        sent_to = commands[-1].task_plan.sends_to if commands else None
        commands.append(_understand(answer, language, sent_to))
    return tuple(commands)


def _understand(
    answer: Mapping[str, Any], language: WorldLanguage, sent_to: TaskValue | None
) -> UnderstoodCommand:
    best = next(iter(answer["candidates"]), None)
    is_unknown = best is None or answer["is_unknown"]
    form: Form = UNKNOWN
    slots: list[Slot] = []
    if best is not None and not is_unknown:
        form = read_form(best["grounded"])
        slots = [
            Slot(
                tuple(each["path"]),
                each["token"],
                each["entity_class"],
                tuple(each["choices"]),
                each["is_named"],
                likely=each["likely"],
                phrases=tuple(each["phrases"]),
                is_choice=each["likely"] is not None and bool(each["phrases"]),
            )
            for each in best["open_slots"]
        ]
    return UnderstoodCommand(
        answer["utterance"],
        is_unknown,
        best["grounded"] if best else "",
        best["english"] if best else "",
        task_plan_of(form, language, slots, answer["utterance"], sent_to=sent_to),
        answer["decision"],
        answer["sureness"],
        answer["probability"],
    )


def _require_few(commands: Sequence[str]) -> None:
    if len(commands) > MOST_COMMANDS:
        raise TooManyCommands(
            f"These are {len(commands)} commands; a robot takes at most {MOST_COMMANDS} at once."
        )
