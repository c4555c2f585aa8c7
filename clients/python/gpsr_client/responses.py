"""The answers of a workbench as typed values. ``raw`` holds the whole answer."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Step:
    """One action of a plan; ``arguments`` maps names to values as docs/reference/plans.md describes them."""

    number: int
    action: str
    predicate: str
    text: str
    arguments: dict[str, dict[str, Any]]
    gives_result: bool

    @classmethod
    def from_json(cls, value: dict[str, Any]) -> Step:
        return cls(
            value["number"],
            value["action"],
            value["predicate"],
            value["text"],
            value["arguments"],
            value["gives_result"],
        )


@dataclass(frozen=True)
class PlanProblem:
    """What stands in the way of a plan; ``step`` 0 is the whole plan.

    In a joint plan ``commands`` are those that it is about.
    """

    code: str
    step: int
    message: str
    hint: str
    commands: tuple[int, ...] = ()

    @classmethod
    def from_json(cls, value: dict[str, Any]) -> PlanProblem:
        return cls(
            value["code"],
            value["step"],
            value["message"],
            value["hint"],
            tuple(value.get("commands", ())),
        )


@dataclass(frozen=True)
class SaidWords:
    """Words of the utterance, in its characters ``start`` to ``end``; None where it does not have them so."""

    text: str
    start: int | None
    end: int | None


@dataclass(frozen=True)
class OpenArgument:
    """What is open in a step: ask ``question``.

    ``argument`` is ``command`` where nothing to do was understood. ``words`` stand there and name nothing. ``likely``
    is a guess. ``asked_in`` is the step of the plan that asks; None where none does.
    """

    argument: str
    question: str
    entity_class: str
    words: tuple[SaidWords, ...]
    likely: str | None
    asked_in: int | None

    @classmethod
    def from_json(cls, value: dict[str, Any]) -> OpenArgument:
        return cls(
            value["argument"],
            value["question"],
            value["entity_class"],
            tuple(SaidWords(each["text"], each["start"], each["end"]) for each in value["words"]),
            value["likely"],
            value["asked_in"],
        )


@dataclass(frozen=True)
class Unresolved:
    """A step that does not ground. ``steps`` are the numbers of the steps of the plan that wait for it.

    ``arguments`` are what is known, as those of a step; a value of the kind ``open`` stands for what is not. In a
    joint plan ``commands`` is the one that it is about.
    """

    steps: tuple[int, ...]
    action: str
    predicate: str
    text: str
    arguments: dict[str, dict[str, Any]]
    open: tuple[OpenArgument, ...]
    commands: tuple[int, ...] = ()

    @classmethod
    def from_json(cls, value: dict[str, Any]) -> Unresolved:
        return cls(
            tuple(value["steps"]),
            value["action"],
            value["predicate"],
            value["text"],
            value["arguments"],
            tuple(map(OpenArgument.from_json, value["open"])),
            tuple(value.get("commands", ())),
        )


@dataclass(frozen=True)
class Plan:
    """The steps of a command. An executable plan needs no further answer from a person.

    ``unresolved`` has the steps that wait for one; the others can be done.
    """

    is_executable: bool
    steps: tuple[Step, ...]
    problems: tuple[PlanProblem, ...]
    unresolved: tuple[Unresolved, ...] = ()

    @classmethod
    def from_json(cls, value: dict[str, Any]) -> Plan:
        return cls(
            value["is_executable"],
            tuple(map(Step.from_json, value["steps"])),
            tuple(map(PlanProblem.from_json, value["problems"])),
            tuple(map(Unresolved.from_json, value["unresolved"])),
        )


@dataclass(frozen=True)
class TaskStep:
    """One primitive of the robot.

    ``arguments``, ``place``, ``holds`` and ``releases`` are values as docs/reference/plans.md has them.
    ``requires`` are the numbers of the steps that have to come before it, ``source`` is that of the step of
    the plan that it belongs to. It ``is_proposed`` where no recipe of the world says how to do it.
    """

    number: int
    primitive: str
    text: str
    arguments: dict[str, dict[str, Any]]
    place: dict[str, Any] | None
    holds: dict[str, Any] | None
    releases: dict[str, Any] | None
    requires: tuple[int, ...]
    gives_result: bool
    source: int
    is_proposed: bool = False

    @classmethod
    def from_json(cls, value: dict[str, Any]) -> TaskStep:
        return cls(
            value["number"],
            value["primitive"],
            value["text"],
            value["arguments"],
            value["place"],
            value["holds"],
            value["releases"],
            tuple(value["requires"]),
            value["gives_result"],
            value["source"],
            value.get("is_proposed", False),
        )


@dataclass(frozen=True)
class TaskPlan:
    """A command in the primitives of the robot, as the recipes of the world say."""

    is_executable: bool
    steps: tuple[TaskStep, ...]
    problems: tuple[PlanProblem, ...]
    unresolved: tuple[Unresolved, ...] = ()

    @classmethod
    def from_json(cls, value: dict[str, Any]) -> TaskPlan:
        return cls(
            value["is_executable"],
            tuple(map(TaskStep.from_json, value["steps"])),
            tuple(map(PlanProblem.from_json, value["problems"])),
            tuple(map(Unresolved.from_json, value["unresolved"])),
        )


@dataclass(frozen=True)
class Interleaving:
    """Steps of several commands that are done together, and why."""

    reason: str
    commands: tuple[int, ...]
    steps: tuple[int, ...]
    message: str


@dataclass(frozen=True)
class Note:
    """What to know about commands of a joint plan.

    ``code`` is ``not_understood``, ``not_interleaved``, ``way_back`` or ``walk``.
    """

    code: str
    commands: tuple[int, ...]
    message: str


@dataclass(frozen=True)
class JointPlan:
    """One plan of several commands, which count from 1.

    ``serves`` has the commands of each step. ``length_before`` is the walk of one command after the other,
    ``length`` that of this plan, both in ``unit`` and with the way to ``ends_at``. ``interleaved`` has the pairs of
    commands that are done together. A command that was not understood is left out and has a note.
    """

    plan: TaskPlan
    serves: tuple[tuple[int, ...], ...]
    interleavings: tuple[Interleaving, ...]
    length_before: float
    length: float
    unit: str
    interleaved: tuple[tuple[int, ...], ...]
    ends_at: dict[str, Any] | None
    notes: tuple[Note, ...]
    spoken: str
    raw: dict[str, Any] = field(repr=False, compare=False)

    @property
    def is_interleaved(self) -> bool:
        return bool(self.interleaved)

    @property
    def not_understood(self) -> tuple[int, ...]:
        """The commands that the plan leaves out."""
        missed = (each.commands for each in self.notes if each.code == "not_understood")
        return tuple(number for numbers in missed for number in numbers)

    @classmethod
    def of_parse(cls, value: dict[str, Any]) -> JointPlan | None:
        """Return that of an answer to ``parse``, spoken as the answer is; None where it has none."""
        keys = ("joint_plan", "spoken")
        return cls.from_json({key: value[key] for key in keys}) if value.get("joint_plan") else None

    @classmethod
    def from_json(cls, value: dict[str, Any]) -> JointPlan:
        joint = value["joint_plan"]
        return cls(
            TaskPlan.from_json(joint),
            tuple(tuple(step["commands"]) for step in joint["steps"]),
            tuple(
                Interleaving(
                    each["reason"], tuple(each["commands"]), tuple(each["steps"]), each["message"]
                )
                for each in joint["interleavings"]
            ),
            joint["length_before"],
            joint["length"],
            joint["unit"],
            tuple(map(tuple, joint["interleaved"])),
            joint["ends_at"],
            tuple(
                Note(each["code"], tuple(each["commands"]), each["message"])
                for each in joint["notes"]
            ),
            value["spoken"],
            value,
        )


@dataclass(frozen=True)
class OpenSlot:
    """Something that the utterance leaves open: the question, and what there is to choose from."""

    entity_class: str
    question: str
    choices: tuple[str, ...]
    likely: str | None
    phrases: tuple[str, ...]

    @classmethod
    def from_json(cls, value: dict[str, Any]) -> OpenSlot:
        return cls(
            value["entity_class"],
            value["question"],
            tuple(value["choices"]),
            value["likely"],
            tuple(value["phrases"]),
        )


@dataclass(frozen=True)
class Candidate:
    """One form: with class tokens, and ``grounded`` with the entities of the utterance.

    ``plan`` has the actions of the form, ``task_plan`` the primitives of the robot; ``spoken`` is what it says
    before it begins. ``warnings`` say what stays open, and why.
    """

    form: str
    grounded: str
    score: float
    english: str
    open_slots: tuple[OpenSlot, ...]
    plan: Plan | None
    task_plan: TaskPlan | None
    spoken: str
    warnings: tuple[str, ...]
    raw: dict[str, Any] = field(repr=False, compare=False)

    @classmethod
    def from_json(cls, value: dict[str, Any]) -> Candidate:
        return cls(
            value["form"],
            value["grounded"],
            value["score"],
            value["english"],
            tuple(map(OpenSlot.from_json, value["open_slots"])),
            Plan.from_json(value["plan"]) if value["plan"] else None,
            TaskPlan.from_json(value["task_plan"]) if value["task_plan"] else None,
            value["spoken"],
            tuple(value["warnings"]),
            value,
        )


@dataclass(frozen=True)
class HeardChange:
    """What was heard otherwise than it was said, in the characters ``start`` to ``end`` of the utterance.

    ``heard`` is empty where something was passed over, ``said`` where something was missing.
    """

    kind: str
    start: int
    end: int
    said: str
    heard: str

    @classmethod
    def from_json(cls, value: dict[str, Any]) -> HeardChange:
        return cls(value["kind"], value["start"], value["end"], value["said"], value["heard"])


@dataclass(frozen=True)
class Reason:
    """Why the robot does not act at once: ``code`` is for programs, ``message`` for people."""

    code: str
    message: str

    @classmethod
    def from_json(cls, value: dict[str, Any]) -> Reason:
        return cls(value["code"], value["message"])


@dataclass(frozen=True)
class Parse:
    """The answer to an utterance: what to do with it, and the candidates, the best first.

    ``decision`` is what a robot may do. ``spoken`` is what it says by it.

    - ``act``: carry out the plan of ``best``. Nothing else is a permission; that a plan is executable is none.
    - ``confirm``: ask ``spoken`` ("Shall I …?"), and carry it out after a yes.
    - ``ask``: something is missing or could be either; ask ``spoken``, or hold a dialogue.
    - ``refuse``: say ``spoken``, which names what stopped it; ``nearest`` are commands that are near.

    ``parser`` is the part that answered, ``run`` its run if it has one. ``agrees``: whether the other part gives the
    same form; None where it was not asked or is silent. ``probability`` is None where nothing was understood,
    ``sureness`` is the same in words. ``heard`` are changes made to the words, ``reasons`` say why it does not act.
    Where the utterance holds several commands, ``several`` has the answer to each, and ``joint_plan`` one plan of all
    of them. ``warnings`` are about class tokens of the utterance that stand for nothing in the world.
    """

    utterance: str
    anonymized: str
    parser: str
    run: int | None
    is_unknown: bool
    decision: str
    probability: float | None
    sureness: str
    spoken: str
    candidates: tuple[Candidate, ...]
    heard: tuple[HeardChange, ...]
    reasons: tuple[Reason, ...]
    nearest: tuple[str, ...]
    agrees: bool | None
    several: tuple[Parse, ...]
    joint_plan: JointPlan | None
    warnings: tuple[str, ...]
    raw: dict[str, Any] = field(repr=False, compare=False)

    @property
    def may_act(self) -> bool:
        """Whether the robot may carry out the plan, and can, without a word of the person: the joint plan of several
        commands, else the task plan of the best candidate."""
        alone = self.best.task_plan if self.best else None
        plan = self.joint_plan.plan if self.joint_plan else alone
        return self.decision == "act" and plan is not None and plan.is_executable

    @property
    def best(self) -> Candidate | None:
        """The best candidate; None where nothing was understood."""
        return None if self.is_unknown or not self.candidates else self.candidates[0]

    @classmethod
    def from_json(cls, value: dict[str, Any]) -> Parse:
        return cls(
            value["utterance"],
            value["anonymized"],
            value["parser"],
            value["run"],
            value["is_unknown"],
            value["decision"],
            value["probability"],
            value["sureness"],
            value["spoken"],
            tuple(map(Candidate.from_json, value["candidates"])),
            tuple(map(HeardChange.from_json, value["heard"])),
            tuple(map(Reason.from_json, value["reasons"])),
            tuple(value["nearest"]),
            value["agrees"],
            tuple(map(Parse.from_json, value.get("several", ()))),
            JointPlan.of_parse(value),
            tuple(value["warnings"]),
            value,
        )
