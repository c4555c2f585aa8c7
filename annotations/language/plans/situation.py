"""What holds while a robot does its steps: where it is, what it has found and what it holds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeAlias

from annotations.language.plans.descriptions import AT
from annotations.language.plans.habitual_places import UsualPlaces, usual_place
from annotations.language.plans.plan import Described, Operator, StepResult, TaskValue, Words
from annotations.language.plans.rows import LASTING, EffectKind, Primitive
from annotations.language.plans.task_plan import RecipeTrouble, TaskProblem, TaskStep
from annotations.language.plans.values import content, is_named_person, said_place, without_place

HERE = Words("here")


@dataclass(frozen=True, slots=True)
class Somewhere:
    """A place that nobody has named: where step ``step`` has led."""

    step: int


Place: TypeAlias = "TaskValue | Somewhere"
Arguments: TypeAlias = Mapping[str, TaskValue]


@dataclass
class Situation:
    """Adds steps one by one, leaves out those whose effects hold already, and says what each requires.

    The robot starts where the operator is, with nothing in its gripper.
    """

    steps: list[TaskStep] = field(default_factory=list)
    problems: list[TaskProblem] = field(default_factory=list)
    place: Place = field(default_factory=Operator)
    held: TaskValue | None = None
    # id → the command that describes it, where several commands share the situation: equal words of two
    # commands mean the same person if they name one, and two things.
    commands: Mapping[str, int] = field(default_factory=dict)
    usual: UsualPlaces = field(default_factory=dict)
    sent_to: TaskValue | None = None  # where the robot is to look, if somebody has said that
    moved_by: int = 0  # the step that has led the robot to its place; 0 where it began
    _taken_by: int = 0
    _taken_at: Place = field(default_factory=Operator)
    _found: list[tuple[TaskValue, int]] = field(default_factory=list)  # here, and by which step
    _whereabouts: dict[str, Place] = field(default_factory=dict)  # id → where it was left
    _located: set[str] = field(default_factory=set)  # ids of what the robot has been where it is
    _met: set[str] = field(default_factory=set)  # ids of what the robot has found or taken
    _same: dict[str, Described] = field(default_factory=dict)  # id → the earlier description of it
    _last_here: set[int] = field(default_factory=set)  # steps here that no other step here requires

    def place_of(self, value: TaskValue) -> Place:
        """Return where something is.

        That is in the gripper, where it was left, or where it is said to be. Else it is where the robot was
        sent to; if it was sent nowhere, where it usually is, or here.
        """
        value = self.known(value)
        owner = _owner(value)
        if self.is_held(owner) or self.step_that_found(owner):
            return self.place
        identity = _identity(owner)
        if identity in self._whereabouts:
            return self._whereabouts[identity]
        said = said_place(value)
        if isinstance(said, Described) and said is not value:
            return self.known(said)
        if said is None and self.sent_to is not None:
            return HERE if self.is_here(self.sent_to) else self.sent_to
        return said or usual_place(value, self.usual) or HERE

    def known(self, value: TaskValue) -> TaskValue:
        """Return the description under which something is known already."""
        return self._same.get(value.id, value) if isinstance(value, Described) else value

    def is_held(self, value: TaskValue) -> bool:
        return self.held is not None and self._is_same(value, self.held, self._taken_at)

    def step_that_found(self, value: TaskValue) -> int:
        """Return the step that found something here; 0 if none has."""
        return next(
            (number for each, number in self._found if self._is_same(value, each, self.place)), 0
        )

    def _is_same(self, value: TaskValue, earlier: TaskValue, place: Place) -> bool:
        """Return whether a value is what the robot came upon at a place.

        What is described in the same words is, when it is mentioned for the first time and not said to be
        elsewhere; later it is known by its id.
        """
        if not isinstance(value, Described) or not isinstance(earlier, Described):
            return content(value) == content(earlier)
        if value.id == earlier.id or value.id in self._met:
            return value.id == earlier.id
        is_of_other = self.commands.get(value.id) != self.commands.get(earlier.id)
        if is_of_other and not is_named_person(value):
            return False
        said = _at(value)
        is_there = said is None or are_equal(said, place)
        return is_there and content(without_place(value)) == content(without_place(earlier))

    def is_here(self, place: Place) -> bool:
        if place == HERE:
            return True
        return are_equal(place, self.place)

    def add(
        self, primitive: Primitive, arguments: Arguments, source: int, is_proposed: bool = False
    ) -> TaskStep | None:
        """Do one primitive.

        Args:
            primitive: what to do.
            arguments: the values of its parameters by name.
            source: the step of the form's plan that it belongs to.
            is_proposed: nobody has written what it does, so that nobody knows where the robot is then, and what
                is there. It stays between what comes before and after it.

        Returns:
            The step; None if all that it does holds already.
        """
        values = {name: self._located_value(self.known(each)) for name, each in arguments.items()}
        if self._holds_already(primitive, values):
            self._recognise(primitive, values)
            return None
        number = len(self.steps) + 1
        requires = self._requirements(primitive, values)
        if is_proposed:
            requires |= self._last_here
        releases = self._change(primitive, values, number, requires)
        if is_proposed:
            self._move(Somewhere(number), number)
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
            is_proposed,
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
                EffectKind.FINDS: self.is_held(value) or bool(self.step_that_found(value)),
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
            here = (each for each, _ in self._found if self._is_same(value, each, self.place))
            earlier = self.held if self.is_held(value) else next(here, None)
            if isinstance(earlier, Described) and earlier.id != value.id:
                self._same[value.id] = earlier

    def _requirements(self, primitive: Primitive, values: Arguments) -> set[int]:
        requires: set[int] = set()
        for value in values.values():
            requires |= results_in(value)
            is_held = self.is_held(_owner(value))
            requires.add(self._taken_by if is_held else self.step_that_found(_owner(value)))
        is_move = primitive.effect(EffectKind.MOVES) is not None
        if is_move or primitive.effect(EffectKind.ACCOMPANIES):
            requires |= self._last_here  # leaving undoes what they need
        if not is_move:
            requires.add(self.moved_by)
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
                self._find(value, number)
            elif effect.kind is EffectKind.TAKES:
                self._take(value, number)
            elif effect.kind is EffectKind.RELEASES:
                releases = self._release(value, values.get(effect.target), number)
            elif effect.kind is EffectKind.ACCOMPANIES:
                self._move(values.get(effect.target, Somewhere(number)), number)
                self._find(value, number)
                self._whereabouts[_identity(value)] = self.place
        return releases

    def _move(self, place: Place, number: int) -> None:
        self.place = place
        if self.sent_to is not None and not are_equal(self.sent_to, place):
            self.sent_to = None
        self.moved_by = number
        self._found.clear()
        self._last_here = {number}

    def _find(self, value: TaskValue, number: int) -> None:
        self._found.append((value, number))
        self._met.add(_identity(value))

    def _take(self, value: TaskValue, number: int) -> None:
        if self.held is not None:
            message = "The robot takes something while it holds something else."
            self.report(
                RecipeTrouble.HANDS_FULL, number, message, "put the first thing down before"
            )
        self.held = value
        self._taken_by = number
        self._taken_at = self.place
        self._found = [
            each for each in self._found if not self._is_same(value, each[0], self.place)
        ]
        self._met.add(_identity(value))

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
        at = _at(value)
        identity = _identity(value)
        if at is None:
            return value
        if identity not in self._located:
            if not self.is_here(at):
                return value
            self._located.add(identity)
        return without_place(value)


def results_in(value: TaskValue) -> set[int]:
    """Return the numbers of the steps whose results a value is, or that its description uses."""
    if isinstance(value, StepResult):
        return {value.step}
    if not isinstance(value, Described):
        return set()
    inner = [each for condition in value.conditions for each in condition.values]
    numbers = set().union(*map(results_in, inner)) if inner else set()
    return numbers | results_in(value.of) if value.of else numbers


def _owner(value: TaskValue) -> TaskValue:
    """Return the person of whom a value is an attribute, else the value."""
    return value.of if isinstance(value, Described) and value.of is not None else value


def _identity(value: TaskValue) -> str:
    owner = _owner(value)
    return owner.id if isinstance(owner, Described) else repr(content(owner))


def _at(value: TaskValue) -> TaskValue | None:
    """Return what something is said to be at; None if that is not said."""
    owner = _owner(value)
    conditions = owner.conditions if isinstance(owner, Described) else ()
    return next(
        (each.values[0] for each in conditions if each.predicate == AT and each.values), None
    )


def are_equal(one: Place, other: Place) -> bool:
    """Return whether two places are the same."""
    if isinstance(one, Somewhere) or isinstance(other, Somewhere):
        return one == other
    return content(one) == content(other)


def with_texts(steps: Sequence[TaskStep], texts: Sequence[str]) -> tuple[TaskStep, ...]:
    """Return the steps with their texts."""
    return tuple(replace(step, text=text) for step, text in zip(steps, texts, strict=True))
