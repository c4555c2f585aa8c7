"""What holds while a robot does its steps: where it is, what it has found and what it holds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TypeAlias

from annotations.language.plans import AT, Described, Operator, StepResult, Words
from annotations.language.recipes.rows import LASTING, EffectKind, Primitive
from annotations.language.recipes.task_plan import RecipeTrouble, TaskProblem, TaskStep
from annotations.language.recipes.values import TaskValue, content, said_place, without_place

HERE = Words("here")


@dataclass(frozen=True, slots=True)
class Somewhere:
    """A place that nobody has named: where step ``step`` has led."""

    step: int


Place: TypeAlias = "TaskValue | Somewhere"
Arguments: TypeAlias = Mapping[str, TaskValue]


@dataclass
class World:
    """Adds steps one by one, leaves out those whose effects hold already, and says what each requires.

    The robot starts where the operator is, with nothing in its gripper.
    """

    steps: list[TaskStep] = field(default_factory=list)
    problems: list[TaskProblem] = field(default_factory=list)
    place: Place = field(default_factory=Operator)
    held: TaskValue | None = None
    _taken_by: int = 0
    _moved_by: int = 0
    _found: dict[Any, tuple[TaskValue, int]] = field(default_factory=dict)
    _whereabouts: dict[str, Place] = field(default_factory=dict)  # id → where it was left
    _located: set[str] = field(default_factory=set)  # ids of what the robot has been where it is
    _same: dict[str, Described] = field(default_factory=dict)  # id → the earlier description of it
    _last_here: set[int] = field(default_factory=set)  # steps here that no other step here requires

    def place_of(self, value: TaskValue) -> Place:
        """Return where something is: in the gripper, where it was left, where it is said to be, or here."""
        value = self.known(value)
        if self.is_held(value) or self._key(value) in self._found:
            return self.place
        identity = _identity(value)
        if identity in self._whereabouts:
            return self._whereabouts[identity]
        said = said_place(value)
        if isinstance(said, Described) and said is not value:
            return self.known(said)
        return self.place if said is None else said

    def known(self, value: TaskValue) -> TaskValue:
        """Return the description under which something is known already."""
        return self._same.get(value.id, value) if isinstance(value, Described) else value

    def is_held(self, value: TaskValue) -> bool:
        return self.held is not None and self._key(self.held) == self._key(value)

    def is_here(self, place: Place) -> bool:
        if place == HERE:
            return True
        if isinstance(place, Somewhere) or isinstance(self.place, Somewhere):
            return place == self.place
        return content(place) == content(self.place)

    def add(self, primitive: Primitive, arguments: Arguments, source: int) -> TaskStep | None:
        """Do one primitive.

        Args:
            primitive: what to do.
            arguments: the values of its parameters by name.
            source: the step of the form's plan that it belongs to.

        Returns:
            The step; None if all that it does holds already.
        """
        values = {name: self._located_value(self.known(each)) for name, each in arguments.items()}
        if self._holds_already(primitive, values):
            self._recognise(primitive, values)
            return None
        number = len(self.steps) + 1
        requires = self._requirements(primitive, values)
        releases = self._change(primitive, values, number, requires)
        step = TaskStep(
            number,
            primitive,
            tuple(values.items()),
            "",
            None if isinstance(self.place, Somewhere) else self.place,
            self.held,
            releases,
            tuple(sorted(requires)),
            source,
        )
        self.steps.append(step)
        return step

    def report(self, trouble: RecipeTrouble, step: int, message: str, hint: str) -> None:
        problem = TaskProblem(trouble, step, message, hint)
        if problem not in self.problems:
            self.problems.append(problem)

    def _holds_already(self, primitive: Primitive, values: Arguments) -> bool:
        kinds = {each.kind for each in primitive.effects}
        if not kinds or not kinds <= LASTING:
            return False
        for each in primitive.effects:
            value = values.get(each.subject)
            if value is None:
                return False
            holds = {
                EffectKind.MOVES: self.is_here(value),
                EffectKind.FINDS: self.is_held(value) or self._key(value) in self._found,
                EffectKind.TAKES: self.is_held(value),
            }
            if not holds[each.kind]:
                return False
        return True

    def _recognise(self, primitive: Primitive, values: Arguments) -> None:
        """Remember that what is to be found is what is here or in the gripper already."""
        for kind in (EffectKind.FINDS, EffectKind.TAKES):
            effect = primitive.effect(kind)
            value = values.get(effect.subject) if effect else None
            if not isinstance(value, Described):
                continue
            earlier = self.held if self.is_held(value) else self._found[self._key(value)][0]
            if isinstance(earlier, Described) and earlier.id != value.id:
                self._same[value.id] = earlier

    def _requirements(self, primitive: Primitive, values: Arguments) -> set[int]:
        requires: set[int] = set()
        for value in values.values():
            requires |= results_in(value)
            if self.is_held(value):
                requires.add(self._taken_by)
            elif self._key(value) in self._found:
                requires.add(self._found[self._key(value)][1])
        is_move = primitive.effect(EffectKind.MOVES) is not None
        if is_move or primitive.effect(EffectKind.ACCOMPANIES):
            requires |= self._last_here  # leaving undoes what they need
        if not is_move:
            requires.add(self._moved_by)
        return requires - {0}

    def _change(
        self, primitive: Primitive, values: Arguments, number: int, requires: set[int]
    ) -> TaskValue | None:
        """Change what holds; return what the step releases."""
        releases = None
        self._last_here = (self._last_here - requires) | {number}
        for effect in sorted(primitive.effects, key=lambda each: list(EffectKind).index(each.kind)):
            value = values.get(effect.subject)
            if value is None:
                continue
            if effect.kind is EffectKind.MOVES:
                self._move(value, number)
            elif effect.kind is EffectKind.FINDS:
                self._found[self._key(value)] = (value, number)
            elif effect.kind is EffectKind.TAKES:
                self._take(value, number)
            elif effect.kind is EffectKind.RELEASES:
                releases = self._release(value, values.get(effect.target), number)
            elif effect.kind is EffectKind.ACCOMPANIES:
                self._move(values.get(effect.target, Somewhere(number)), number)
                self._found[self._key(value)] = (value, number)
                self._whereabouts[_identity(value)] = self.place
        return releases

    def _move(self, place: Place, number: int) -> None:
        self.place = place
        self._moved_by = number
        self._found.clear()
        self._last_here = {number}

    def _take(self, value: TaskValue, number: int) -> None:
        if self.held is not None:
            message = "The robot takes something while it holds something else."
            self.report(
                RecipeTrouble.HANDS_FULL, number, message, "put the first thing down before"
            )
        self.held = value
        self._taken_by = number
        self._found.pop(self._key(value), None)

    def _release(self, value: TaskValue, target: TaskValue | None, number: int) -> TaskValue:
        if not self.is_held(value):
            message = "The robot lets go of something that it does not hold."
            self.report(RecipeTrouble.NOT_HELD, number, message, "take it before")
        self.held = None
        is_place = target is not None and said_place(target) == target
        self._whereabouts[_identity(value)] = target if target and is_place else self.place
        return value

    def _located_value(self, value: TaskValue) -> TaskValue:
        """Return a value without its place, where the robot is there or has been."""
        if not isinstance(value, Described):
            return value
        owner = value.of or value
        at = next((each for each in owner.conditions if each.predicate == AT and each.values), None)
        if at is None:
            return value
        if owner.id not in self._located:
            if not self.is_here(at.values[0]):
                return value
            self._located.add(owner.id)
        return without_place(value)

    def _key(self, value: TaskValue) -> tuple[Any, ...]:
        return content(without_place(value) if isinstance(value, Described) else value)


def results_in(value: TaskValue) -> set[int]:
    """Return the numbers of the steps whose results a value is, or that its description uses."""
    if isinstance(value, StepResult):
        return {value.step}
    if not isinstance(value, Described):
        return set()
    inner = [each for condition in value.conditions for each in condition.values]
    numbers = set().union(*map(results_in, inner)) if inner else set()
    return numbers | results_in(value.of) if value.of else numbers


def _identity(value: TaskValue) -> str:
    if isinstance(value, Described):
        return _identity(value.of) if value.of is not None else value.id
    return repr(content(value))


def with_texts(steps: Sequence[TaskStep], texts: Sequence[str]) -> tuple[TaskStep, ...]:
    """Return the steps with their texts."""
    return tuple(replace(step, text=text) for step, text in zip(steps, texts, strict=True))
