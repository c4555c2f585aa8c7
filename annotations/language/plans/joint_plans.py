"""Do up to three commands in one go: one task plan that keeps the order inside each and walks little.

A command is cut into *visits*: what it does at one place. An exact search over the orders of visits (dynamic
programming over how far each command is and which one was served last, after Held and Karp, 1962) finds the
shortest walk. Commands of usual length have some hundred states.

A command is cut before each move, after the robot has let go of something, after it has accompanied
somebody, and after a question to the operator. To cut it anywhere else saves no walk: what comes before
such a cut can be done right before what comes after it.

What the recipe book has for ``after_commands()``, such as going back to the operator, comes once at the end,
and the search counts that way too.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import cache
from itertools import combinations, groupby, pairwise
from math import isfinite, prod
from typing import Any, TypeAlias

from annotations.language.forms import (
    ROOM_CLASS,
)
from annotations.language.grounding import NOT_UNDERSTOOD
from annotations.language.plans.book import RecipeBook
from annotations.language.plans.plan import (
    ASK,
    Named,
    Operator,
    TaskValue,
    Trouble,
    Unresolved,
    Words,
)
from annotations.language.plans.rows import (
    OPERATOR_WORD,
    EffectKind,
    Literal,
    Primitive,
    TheOperator,
)
from annotations.language.plans.situation import Place, Situation, Somewhere, are_equal, with_texts
from annotations.language.plans.speaking import ORDINALS, spoken, step_texts
from annotations.language.plans.task_plan import (
    RecipeTrouble,
    TaskPlan,
    TaskProblem,
    TaskStep,
    task_plan_schema,
)
from annotations.language.plans.values import ids_in, renumbered, with_results
from annotations.language.texts import Refusal, definite

MOST_COMMANDS = 3
MOST_STATES = 20_000  # about half a second; longer commands are done one after the other
# Without a table the walk counts the ways from room to room; one inside a room is half of such a way.
SAME_ROOM, OTHER_ROOM = 0.5, 1.0
ROOMS, METRES = "rooms", "m"
_NOTHING_HEARD = frozenset((Trouble.NOT_UNDERSTOOD, Trouble.NO_ACTION))


class TooManyCommands(Refusal):
    """More commands at once than a robot is given."""

    code = "too_many_commands"


class WrongDistance(Refusal):
    """A table of distances that has no sense."""

    code = "wrong_distance"


class Reason(StrEnum):
    """Why steps of several commands come together, or in another order."""

    SHARED_VISIT = "shared_visit"
    SAME_ROOM = "same_room"
    SHORTER = "shorter"
    HANDS = "hands"


@dataclass(frozen=True, slots=True)
class Interleaving:
    """Steps of several commands that come together, and why, in a sentence.

    ``steps`` are those with which the commands come in; empty where it is about the whole order.
    """

    reason: Reason
    commands: tuple[int, ...]
    steps: tuple[int, ...]
    message: str

    def as_json(self) -> dict[str, Any]:
        return {
            "reason": str(self.reason),
            "commands": list(self.commands),
            "steps": list(self.steps),
            "message": self.message,
        }


class NoteKind(StrEnum):
    """What a person should know about a joint plan."""

    NOT_UNDERSTOOD = "not_understood"  # the plan does the other commands
    NOT_INTERLEAVED = "not_interleaved"  # commands that bring no points for interleaving
    WAY_BACK = "way_back"  # where the robot ends, and that the walk counts it
    WALK = "walk"  # what the walk counts


@dataclass(frozen=True, slots=True)
class Note:
    """A sentence about some commands of a joint plan."""

    code: NoteKind
    commands: tuple[int, ...]
    message: str

    def as_json(self) -> dict[str, Any]:
        return {"code": str(self.code), "commands": list(self.commands), "message": self.message}


@dataclass(frozen=True, slots=True)
class JointPlan:
    """One plan of several commands, which count from 1.

    ``serves`` names the commands that each step is for. ``length_before`` is the walk of one command after
    the other, ``length`` that of this plan, both in the ``unit`` of the distances and with the way to where the
    robot ends. ``interleaved`` has the pairs of commands of which one is done while the other is not finished,
    or that share a step. ``ends_at`` is where the recipe book sends the robot after all commands; None where it
    does not.
    """

    plan: TaskPlan
    serves: tuple[tuple[int, ...], ...]
    waiting: tuple[int, ...]
    interleavings: tuple[Interleaving, ...]
    length_before: float
    length: float
    unit: str
    interleaved: tuple[tuple[int, int], ...]
    ends_at: TaskValue | None
    notes: tuple[Note, ...]

    @property
    def is_interleaved(self) -> bool:
        return bool(self.interleaved)

    @property
    def spoken(self) -> str:
        """What the robot says: which commands it has not understood, and what it will do."""
        missed = (each.message for each in self.notes if each.code is NoteKind.NOT_UNDERSTOOD)
        return " ".join((*missed, spoken(self.plan)))

    def as_json(self) -> dict[str, Any]:
        """Return plain data that follow ``joint_plan_schema``."""
        plan = self.plan.as_json()
        for step, commands in zip(plan["steps"], self.serves, strict=True):
            step["commands"] = list(commands)
        for problem in plan["problems"]:
            at = problem["step"]
            problem["commands"] = list(self.serves[at - 1]) if at else []
        for entry, command in zip(plan["unresolved"], self.waiting, strict=True):
            entry["commands"] = [command]
        return {
            **plan,
            "interleavings": [each.as_json() for each in self.interleavings],
            "length_before": self.length_before,
            "length": self.length,
            "unit": self.unit,
            "is_interleaved": self.is_interleaved,
            "interleaved": [list(each) for each in self.interleaved],
            "ends_at": self.ends_at and self.ends_at.as_json(),
            "notes": [each.as_json() for each in self.notes],
        }


@dataclass(frozen=True)
class Distances:
    """How far two places are from each other.

    ``table`` has the names of two places, in either order, and their distance; the operator is called
    ``operator``. Where it lacks a place it may have the room. A pair that it does not have is as far as its
    farthest one, so that no plan looks short by a way that nobody has measured. Without a table two places
    of one room are half a room apart and others one.
    """

    table: Mapping[tuple[str, str], float] = field(default_factory=dict)
    unit: str = METRES  # of the table

    @classmethod
    def of_rows(cls, rows: Iterable[tuple[str, str, float]], unit: str = METRES) -> Distances:
        """Return the distances of a table with two places and their distance a row.

        Raises:
            WrongDistance: a distance is negative or no number, a pair has two, or a place is away from itself.
        """
        table: dict[tuple[str, str], float] = {}
        for one, other, distance in rows:
            if not (isfinite(distance) and distance >= 0):
                raise WrongDistance(f"From {one} to {other} is no distance: {distance}.")
            if one == other and distance:
                raise WrongDistance(f"From {one} to itself is no distance: {distance}.")
            if table.get((other, one), table.get((one, other), distance)) != distance:
                raise WrongDistance(f"There are two distances from {one} to {other}.")
            table[one, other] = distance
        return cls(table, unit)

    @property
    def measure(self) -> str:
        """The unit of a walk."""
        return self.unit if self.table else ROOMS

    def between(self, one: Place, other: Place) -> float:
        """Return the distance of two places; 0 if they are the same."""
        if are_equal(one, other):
            return 0.0
        rooms = _room(one), _room(other)
        is_one_room = rooms[0] == rooms[1] != ""
        if not self.table:
            return SAME_ROOM if is_one_room else OTHER_ROOM
        places = _name(one), _name(other)
        for first, second in (places, (rooms[0] or places[0], rooms[1] or places[1])):
            measured = self.table.get((first, second), self.table.get((second, first)))
            if measured is not None:
                return measured
        return 0.0 if is_one_room else max(self.table.values())


def join(
    plans: Sequence[TaskPlan],
    book: RecipeBook,
    distances: Distances | None = None,
    utterances: Sequence[str] = (),
) -> JointPlan:
    """Return one plan that does several commands.

    The order inside each command is kept, the robot holds one thing at a time, nobody is left in the middle
    of a conversation or on the way, and the walk is as short as that allows. Where two orders are equally
    good, the robot changes less often between commands and begins with the first. Commands of which each
    keeps what it has taken cannot both be done; that is a problem of the plan. A command that was not understood
    is left out and named, unless none of them was understood. At the end comes what the book has for
    ``after_commands()``.

    Args:
        plans: up to three task plans, in the order in which the commands were given.
        book: has the primitive that brings the robot back to where a command goes on, and what comes at the end.
        distances: of the world's places.
        utterances: the commands as they were said, to name those that were not understood.

    Raises:
        TooManyCommands: there are more plans.
    """
    if len(plans) > MOST_COMMANDS:
        raise TooManyCommands(f"A robot does at most {MOST_COMMANDS} commands at once.")
    distances = distances or Distances()
    names = [_say_which(number, utterances) for number, _ in enumerate(plans)]
    understood = [not _is_not_understood(each) for each in plans]
    done = list(plans)
    if len(plans) > 1:
        done = [_naming_command(plan, name) for plan, name in zip(plans, names, strict=True)]
    if any(understood):  # the others are only named
        done = [
            plan if is_heard else _without_steps(plan)
            for plan, is_heard in zip(done, understood, strict=True)
        ]
    commands = [_Command.of(plan, number) for number, plan in enumerate(done, start=1)]
    ending = _ending(book)
    search = _Search(commands, distances, ending)
    in_turn = [number for number, each in enumerate(commands) for _ in each.visits]
    order = search.best_order() if search.is_small else in_turn
    before, after = search.cost(in_turn), search.cost(order)
    writer = _Writer(commands, _mover(book), distances.measure)
    for number in order:
        writer.add(number)
    interleavings = tuple(writer.interleavings(before, after))
    interleaved = writer.interleaved()
    writer.end(ending)
    missed = [
        Note(NoteKind.NOT_UNDERSTOOD, (number,), f"I did not understand {name}.")
        for number, (name, is_heard) in enumerate(zip(names, understood, strict=True), start=1)
        if any(understood) and not is_heard
    ]
    served = tuple(each.number for each in commands if each.visits)
    return JointPlan(
        writer.plan(done),
        writer.serves(),
        tuple(number for number, plan in enumerate(done, start=1) for _ in plan.unresolved),
        interleavings,
        before.length,
        after.length,
        distances.measure,
        interleaved,
        ending[-1].place if ending else None,
        (
            *missed,
            *_notes_about_interleaving(served, interleaved),
            *_notes_about_the_walk(served, ending, distances),
        ),
    )


def _is_not_understood(plan: TaskPlan) -> bool:
    """Return whether a plan only asks what to do, since nothing of the command was understood."""
    is_asking = all(_is_question(step) or step.action == ASK for step in plan.steps)
    return is_asking and any(each.code in _NOTHING_HEARD for each in plan.problems)


def _say_which(number: int, utterances: Sequence[str]) -> str:
    said = "".join(utterances[number : number + 1])
    return f"the {ORDINALS[number]} command" + (f": “{said}”" if said else "")


def _naming_command(plan: TaskPlan, name: str) -> TaskPlan:
    """Return a plan whose questions say in which command something was not understood."""
    about_all = f"I did not understand {name}. What shall I do?"
    about_part = f"I did not understand a part of {name}. What shall I do?"
    question = about_all if _is_not_understood(plan) else about_part

    def named(value: TaskValue) -> TaskValue:
        is_general = isinstance(value, Words) and value.text == NOT_UNDERSTOOD
        return Words(question, is_of_robot=True) if is_general else value

    steps = (
        replace(step, arguments=tuple((name, named(value)) for name, value in step.arguments))
        for step in plan.steps
    )
    unresolved = (
        replace(
            each,
            open=tuple(
                replace(gap, question=question) if gap.question == NOT_UNDERSTOOD else gap
                for gap in each.open
            ),
        )
        for each in plan.unresolved
    )
    return replace(plan, steps=tuple(steps), unresolved=tuple(unresolved))


def _without_steps(plan: TaskPlan) -> TaskPlan:
    return TaskPlan((), (), tuple(renumbered(each, {}, {}) for each in plan.unresolved))


@dataclass(frozen=True, slots=True)
class _Last:
    """A primitive that is done after all commands; ``place`` is where the robot is then, None where it was."""

    primitive: Primitive
    values: Mapping[str, TaskValue]
    place: TaskValue | None


def _ending(book: RecipeBook) -> tuple[_Last, ...]:
    """Return what a book has for ``after_commands()``."""
    ending: list[_Last] = []
    for call in book.after_commands:
        primitive = book.primitive(call.primitive)
        assert primitive is not None
        values: dict[str, TaskValue] = {}
        for parameter, argument in zip(primitive.parameters, call.arguments, strict=False):
            if isinstance(argument, TheOperator):
                values[parameter.name] = Operator()
            elif isinstance(argument, Literal):
                values[parameter.name] = Words(argument.text, is_of_robot=True)
        moves = primitive.effect(EffectKind.MOVES)
        before = ending[-1].place if ending else None
        ending.append(_Last(primitive, values, values.get(moves.subject) if moves else before))
    return tuple(ending)


def _notes_about_interleaving(
    commands: Sequence[int], interleaved: Sequence[tuple[int, int]]
) -> Iterator[Note]:
    """Yield what says which of several commands bring no points for interleaving."""
    alone = tuple(each for each in commands if not any(each in pair for pair in interleaved))
    if len(commands) < 2 or not alone:
        return
    message = "The commands are done one after the other, so they bring no points for interleaving."
    if len(alone) < len(commands):
        (number,) = alone
        message = f"Command {number} is done on its own, so it brings no points for interleaving."
    yield Note(NoteKind.NOT_INTERLEAVED, alone, message)


def _notes_about_the_walk(
    commands: Sequence[int], ending: Sequence[_Last], distances: Distances
) -> Iterator[Note]:
    """Yield where the robot ends, and what the walk counts."""
    if not commands:
        return
    place = ending[-1].place if ending else None
    message = "The recipe book does not say where the robot goes after all commands."
    if place is not None:
        where = "back to you" if isinstance(place, Operator) else f"to {definite(_name(place))}"
        message = f"After all commands the robot goes {where}; the walk counts that way."
    yield Note(NoteKind.WAY_BACK, tuple(commands), message)
    message = f"The walk is in {distances.measure}, as the table of distances has it."
    if not distances.table:
        message = "The walk counts the ways to another room, and a way inside a room as a half."
    yield Note(NoteKind.WALK, tuple(commands), message)


def say_length(length: float, unit: str) -> str:
    """Return the length of a walk with its unit: ``3.5 rooms``, ``1 room``, ``12.3 m``."""
    number = f"{length:.1f}".removesuffix(".0")
    return f"{number} {'room' if (number, unit) == ('1', ROOMS) else unit}"


@cache
def joint_plan_schema_text() -> str:
    """Return the JSON Schema (2020-12) that ``JointPlan.as_json`` follows, as text."""
    return json.dumps(joint_plan_schema(), indent=2) + "\n"


def joint_plan_schema() -> dict[str, Any]:
    """Return the JSON Schema that ``JointPlan.as_json`` follows: that of task plans and what joint ones add."""
    schema = task_plan_schema()
    schema["$id"] = "urn:gpsr-workbench:joint-plan:2"
    schema["title"] = "Joint plan"
    schema["description"] = (
        "The primitives that do several commands in one go, and why in this order."
    )
    numbers = {"type": "array", "items": {"type": "integer", "minimum": 1}}
    step = schema["$defs"]["step"]
    step["required"].append("commands")
    step["properties"]["commands"] = {"description": "The commands that it is for.", **numbers}
    for name in ("problem", "unresolved"):
        about = schema["$defs"][name]
        about["required"].append("commands")
        about["properties"]["commands"] = {"description": "Those that it is about.", **numbers}
    length = {"type": "number", "minimum": 0}
    schema["required"] += ["interleavings", "length_before", "length", "unit"]
    schema["required"] += ["is_interleaved", "interleaved", "ends_at", "notes"]
    schema["properties"] |= {
        "interleavings": {"type": "array", "items": {"$ref": "#/$defs/interleaving"}},
        "length_before": {"description": "The walk of one command after the other.", **length},
        "length": {"description": "The walk of this plan, to where the robot ends.", **length},
        "unit": {"description": "Of both: m, rooms, or as was sent.", "type": "string"},
        "is_interleaved": {"description": "Whether any two are interleaved.", "type": "boolean"},
        "interleaved": {
            "description": "Pairs of commands that share a step, or of which one is done inside the other.",
            "type": "array",
            "items": {**numbers, "minItems": 2, "maxItems": 2},
        },
        "ends_at": {
            "description": "Where the recipe book sends the robot after all commands.",
            "oneOf": [{"$ref": "#/$defs/value"}, {"type": "null"}],
        },
        "notes": {
            "description": "What to know about the plan.",
            "type": "array",
            "items": {"$ref": "#/$defs/note"},
        },
    }
    schema["$defs"]["note"] = {
        "type": "object",
        "required": ["code", "commands", "message"],
        "additionalProperties": False,
        "properties": {
            "code": {"enum": [str(each) for each in NoteKind]},
            "commands": numbers,
            "message": {"type": "string", "minLength": 1},
        },
    }
    schema["$defs"]["interleaving"] = {
        "description": "Steps of several commands that come together, and why.",
        "type": "object",
        "required": ["reason", "commands", "steps", "message"],
        "additionalProperties": False,
        "properties": {
            "reason": {"enum": [str(each) for each in Reason]},
            "commands": numbers,
            "steps": numbers,
            "message": {"type": "string", "minLength": 1},
        },
    }
    return schema


@dataclass(frozen=True, slots=True)
class _Visit:
    """Steps of one command that are done without a break, what they need and what they leave behind."""

    steps: tuple[TaskStep, ...]
    start: Place  # where the robot has to be
    end: Place
    uses_gripper: bool
    holds: bool  # whether the robot holds something of this command afterwards
    is_bound: bool  # whether the robot may not go elsewhere before the next visit of this command
    is_question: bool  # to the operator


@dataclass(frozen=True, slots=True)
class _Command:
    number: int
    visits: tuple[_Visit, ...]

    @classmethod
    def of(cls, plan: TaskPlan, number: int) -> _Command:
        """Cut a plan into visits; its ids and steps get names that no other command has."""
        pieces: list[list[TaskStep]] = []
        for step in _renamed(plan.steps, number):
            if not pieces or _has(step, EffectKind.MOVES) or _ends_visit(pieces[-1][-1]):
                pieces.append([])
            pieces[-1].append(step)
        visits = []
        place: Place = Operator()
        for at, piece in enumerate(pieces):
            start = _place(piece[0], place) if _has(piece[0], EffectKind.MOVES) else place
            for step in piece:
                place = _place(step, place)
            uses_gripper = any(_has(step, EffectKind.TAKES, EffectKind.ACTS) for step in piece)
            visits.append(
                _Visit(
                    tuple(piece),
                    start,
                    place,
                    uses_gripper,
                    holds=piece[-1].holds is not None,
                    is_bound=_is_bound(pieces, at),
                    is_question=_is_question(piece[-1]),
                )
            )
        return cls(number, tuple(visits))


def _ends_visit(step: TaskStep) -> bool:
    return _has(step, EffectKind.RELEASES, EffectKind.ACCOMPANIES) or _is_question(step)


def _is_question(step: TaskStep) -> bool:
    """Return whether a step asks the operator something: it speaks to nobody else, and learns the answer."""
    speaks = step.primitive.effect(EffectKind.SPEAKS)
    return step.gives_result and speaks is not None and not speaks.subject


def _is_bound(pieces: Sequence[Sequence[TaskStep]], at: int) -> bool:
    """Return whether what comes after a piece needs somebody or something that is found here.

    Also if the robot could not come back, because nobody has named the place.
    """
    rest = [step for piece in pieces[at + 1 :] for step in piece]
    if not rest or _has(rest[0], EffectKind.MOVES):
        return False
    if pieces[at][-1].place is None:
        return True
    done = [step for piece in pieces[: at + 1] for step in piece]
    found = {step.number for step in done if _has(step, EffectKind.FINDS, EffectKind.ACCOMPANIES)}
    for step in rest:
        if _has(step, EffectKind.MOVES):
            return False
        if found.intersection(step.requires):
            return True
    return False


def _renamed(steps: Sequence[TaskStep], command: int) -> list[TaskStep]:
    """Return steps with numbers and ids that only this command uses."""
    numbers = {step.number: _unique(step.number, command) for step in steps}
    ids = {each: _unique_id(each, command) for each in _ids(steps)}
    return [
        replace(
            _with_names(step, numbers, ids),
            number=numbers[step.number],
            requires=tuple(numbers[each] for each in step.requires),
        )
        for step in steps
    ]


def _unique(number: int, command: int) -> int:
    return number * (MOST_COMMANDS + 1) + command


def _unique_id(name: str, command: int) -> str:
    return f"x{_unique(int(name[1:]), command)}"


def _ids(steps: Iterable[TaskStep]) -> dict[str, None]:
    """Return the ids of what steps are about, in the order of mention."""
    values = [value for step in steps for _, value in step.arguments]
    return dict.fromkeys(each for value in values for each in ids_in(value))


def _with_names(
    step: TaskStep, numbers: Mapping[int, int], ids: Mapping[str, str] | None = None
) -> TaskStep:
    """Return a step whose values have other numbers of steps and other ids."""

    def renamed(value: TaskValue | None) -> TaskValue | None:
        return None if value is None else with_results(value, numbers, ids)

    return replace(
        step,
        arguments=tuple((name, with_results(each, numbers, ids)) for name, each in step.arguments),
        place=renamed(step.place),
        holds=renamed(step.holds),
        releases=renamed(step.releases),
    )


@dataclass(frozen=True, slots=True, order=True)
class _Cost:
    """What an order of visits costs, the most important first."""

    conflicts: int = 0  # visits that need the gripper while it is full
    length: float = 0.0
    moves: int = 0
    late_questions: int = (
        0  # what is done before a question that could be asked, summed over visits
    )
    changes: int = 0  # from one command to another
    overtaking: int = 0  # earlier commands that are not finished, summed over visits

    def plus(self, other: _Cost) -> _Cost:
        return _Cost(
            self.conflicts + other.conflicts,
            self.length + other.length,
            self.moves + other.moves,
            self.late_questions + other.late_questions,
            self.changes + other.changes,
            self.overtaking + other.overtaking,
        )


# How many visits of each command are done, and the command that was served last; -1 at the beginning.
_State: TypeAlias = tuple[tuple[int, ...], int]


class _Search:
    """Finds the best order of visits."""

    def __init__(
        self, commands: Sequence[_Command], distances: Distances, ending: Sequence[_Last]
    ) -> None:
        self._commands = commands
        self._distances = distances
        self._ending = ending
        self._begin: _State = (tuple(0 for _ in commands), -1)
        self._goal = tuple(len(each.visits) for each in commands)

    @property
    def is_small(self) -> bool:
        """Whether an exact search is quick enough."""
        return prod(each + 1 for each in self._goal) * len(self._goal) <= MOST_STATES

    def best_order(self) -> list[int]:
        """Return the commands in the order in which they are served, one entry a visit."""
        best: dict[_State, tuple[_Cost, _State]] = {self._begin: (_Cost(), self._begin)}
        layer = [self._begin]
        for _ in range(sum(self._goal)):
            following: dict[_State, None] = {}
            for state in layer:
                for number in range(len(self._goal)):
                    step = self._step(state, number)
                    if step is None:
                        continue
                    reached, cost = step
                    total = best[state][0].plus(cost)
                    if reached not in best or total < best[reached][0]:
                        best[reached] = (total, state)
                    following[reached] = None
            layer = list(following)
        state = min(layer, key=lambda each: best[each][0].plus(self._cost_of_ending(each)))
        order = []
        while state != self._begin:
            order.append(state[1])
            state = best[state][1]
        return order[::-1]

    def cost(self, order: Iterable[int]) -> _Cost:
        """Return what an order of commands costs, with the way to where the robot ends."""
        state, cost = self._begin, _Cost()
        for number in order:
            step = self._step(state, number)
            assert step is not None
            state, cost = step[0], cost.plus(step[1])
        return cost.plus(self._cost_of_ending(state))

    def _place_in(self, state: _State) -> Place:
        done, last = state
        return self._commands[last].visits[done[last] - 1].end if last >= 0 else Operator()

    def _cost_of_ending(self, state: _State) -> _Cost:
        """Return what comes after all commands; nothing where no command was done."""
        place, cost = self._place_in(state), _Cost()
        for each in self._ending if state[1] >= 0 else ():
            if each.place is not None and not are_equal(place, each.place):
                cost = cost.plus(_Cost(0, self._distances.between(place, each.place), 1))
                place = each.place
        return cost

    def _step(self, state: _State, number: int) -> tuple[_State, _Cost] | None:
        """Return the state after the next visit of a command, and its cost; None if it cannot come now."""
        done, last = state
        if done[number] == self._goal[number]:
            return None
        visit = self._commands[number].visits[done[number]]
        place = self._place_in(state)
        others = [
            each.visits[count - 1]
            for at, (each, count) in enumerate(zip(self._commands, done, strict=True))
            if at != number and count
        ]
        is_here = are_equal(place, visit.start)
        if any(each.is_bound for each in others) and not (is_here and are_equal(place, visit.end)):
            return None
        cost = _Cost(
            int(visit.uses_gripper and any(each.holds for each in others)),
            self._distances.between(place, visit.start)
            + self._distances.between(visit.start, visit.end),
            int(not is_here),
            0 if visit.is_question else self._open_questions(done),
            int(last not in (-1, number)),
            sum(done[at] < self._goal[at] for at in range(number)),
        )
        return ((*done[:number], done[number] + 1, *done[number + 1 :]), number), cost

    def _open_questions(self, done: tuple[int, ...]) -> int:
        return sum(
            count < len(each.visits) and each.visits[count].is_question
            for each, count in zip(self._commands, done, strict=True)
        )


@dataclass(frozen=True, slots=True)
class _Stop:
    """A visit in the joint plan: the step that led there (0 at the beginning), and the first step there."""

    place: Place
    command: int
    arrival: int
    first: int


class _Writer:
    """Writes the visits in their order as one plan."""

    def __init__(self, commands: Sequence[_Command], mover: Primitive | None, unit: str) -> None:
        self._commands = commands
        self._mover = mover
        self._unit = unit
        self._next = [0 for _ in commands]
        self._situation = Situation(
            commands={
                each: command.number
                for command in commands
                for visit in command.visits
                for each in _ids(visit.steps)
            }
        )
        self._numbers: dict[int, int] = {}  # step of a command → of the joint plan
        self._serves: list[set[int]] = []
        self._stops: list[_Stop] = []

    def add(self, number: int) -> None:
        """Add the next visit of a command."""
        command = self._commands[number]
        visit = command.visits[self._next[number]]
        self._next[number] += 1
        first = len(self._situation.steps) + 1
        self._return_to(visit, command.number)
        arrival = self._situation.moved_by
        for step in visit.steps:
            values = dict(_with_names(step, self._numbers).arguments)
            done = self._situation.add(step.primitive, values, step.source, step.is_proposed)
            if done is not None:
                self._numbers[step.number] = done.number
                self._serves.append({command.number})
            elif shared := self._doer(step, values):
                self._numbers[step.number] = shared
                self._serves[shared - 1].add(command.number)
            if step is visit.steps[0] and _has(step, EffectKind.MOVES):
                arrival = self._situation.moved_by
        self._stops.append(_Stop(visit.start, command.number, arrival, first))

    def _return_to(self, visit: _Visit, command: int) -> None:
        """Go back to where a command goes on; a visit that begins with a move does so itself."""
        start = visit.start
        first = visit.steps[0]
        if _has(first, EffectKind.MOVES) or first.is_proposed or isinstance(start, Somewhere):
            return
        moves = self._mover.effect(EffectKind.MOVES) if self._mover else None
        if self._mover is None or moves is None:
            return
        place = with_results(start, self._numbers)
        if self._situation.add(self._mover, {moves.subject: place}, first.source):
            self._serves.append({command})

    def _doer(self, step: TaskStep, values: Mapping[str, TaskValue]) -> int:
        """Return the step of the joint plan that has done already what a step does; 0 if none had to."""
        finds = step.primitive.effect(EffectKind.FINDS)
        value = values.get(finds.subject) if finds else None
        if value is None or _has(step, EffectKind.MOVES):
            return self._situation.moved_by
        return self._situation.step_that_found(self._situation.known(value))

    def end(self, ending: Sequence[_Last]) -> None:
        """Add what comes after all commands; it is for all of them."""
        everyone = {each.number for each in self._commands if each.visits}
        for each in ending if everyone else ():
            if self._situation.add(each.primitive, each.values, 0) is not None:
                self._serves.append(everyone)

    def interleaved(self) -> tuple[tuple[int, int], ...]:
        """Return the pairs of commands that share a step, or of which one begins before the other is finished.

        Questions to the operator do not count: they come first, whoever they are for.
        """
        steps: dict[int, list[int]] = {}
        for step, commands in zip(self._situation.steps, self._serves, strict=True):
            for command in commands if not _is_question(step) else ():
                steps.setdefault(command, []).append(step.number)
        return tuple(
            (one, other)
            for one, other in combinations(sorted(steps), 2)
            if steps[one][0] <= steps[other][-1] and steps[other][0] <= steps[one][-1]
        )

    def serves(self) -> tuple[tuple[int, ...], ...]:
        return tuple(tuple(sorted(each)) for each in self._serves)

    def plan(self, plans: Sequence[TaskPlan]) -> TaskPlan:
        """Return the steps with ids in the order of mention, and the problems of all commands."""
        ids = {old: f"x{number}" for number, old in enumerate(_ids(self._situation.steps), start=1)}
        same = {step.number: step.number for step in self._situation.steps}
        steps = [_with_names(step, same, ids) for step in self._situation.steps]
        problems = [
            replace(each, step=self._step_of(each, command))
            for command, plan in enumerate(plans, start=1)
            for each in plan.problems
        ]
        unresolved = (
            each
            for command, plan in enumerate(plans, start=1)
            for each in self._renumber(plan, command, ids)
        )
        known = {(each.code, each.step) for each in problems}
        hint = "do one of the commands later"
        added = (
            TaskProblem(each.code, each.step, each.message, hint)
            for each in self._situation.problems
            if each.code == RecipeTrouble.HANDS_FULL and (each.code, each.step) not in known
        )
        texts = step_texts(steps)
        return TaskPlan(with_texts(steps, texts), (*problems, *added), tuple(unresolved))

    def _renumber(
        self, plan: TaskPlan, command: int, ids: Mapping[str, str]
    ) -> Iterator[Unresolved]:
        """Yield what is not resolved of a command, with the numbers and the ids of the joint plan."""
        numbers = {
            step.number: self._numbers[_unique(step.number, command)]
            for step in plan.steps
            if _unique(step.number, command) in self._numbers
        }
        own = {each: ids.get(_unique_id(each, command), each) for each in _ids(plan.steps)}
        for each in plan.unresolved:
            yield renumbered(each, {old: [new] for old, new in numbers.items()}, numbers, own)

    def _step_of(self, problem: TaskProblem, command: int) -> int:
        """Return the step that a problem is about: the first of its command where it is about all of that one."""
        of_command = (at for at, each in enumerate(self._serves, start=1) if command in each)
        return self._numbers.get(_unique(problem.step, command)) or next(of_command, 0)

    def interleavings(self, before: _Cost, after: _Cost) -> Iterator[Interleaving]:
        """Yield what comes together and why."""
        stays = [list(group) for _, group in groupby(self._stops, key=lambda each: each.arrival)]
        for stay in stays:
            yield from self._shared_visit(stay)
        is_shorter = after.length < before.length
        for one, other in pairwise(stays):
            if is_shorter:
                yield from _same_room(one[-1], other[0])
        everyone = tuple(each.number for each in self._commands if each.visits)
        if is_shorter:
            lengths = [say_length(each.length, self._unit) for each in (after, before)]
            message = f"The walk is {' instead of '.join(lengths)} for one command after the other."
            yield Interleaving(Reason.SHORTER, everyone, (), message)
        if after.conflicts < before.conflicts:
            message = "The robot holds one thing at a time, so what it keeps it takes last."
            yield Interleaving(Reason.HANDS, everyone, (), message)

    def _shared_visit(self, stay: Sequence[_Stop]) -> Iterator[Interleaving]:
        arrival, place = stay[0].arrival, stay[0].place
        if not arrival or isinstance(place, Somewhere):
            return
        commands = self._serves[arrival - 1]
        if not isinstance(
            place, Operator
        ):  # where commands that merely begin have nothing to share
            commands = commands | {each.command for each in stay}
        if len(commands) < 2:
            return
        numbers = tuple(sorted(commands))
        steps = tuple(dict.fromkeys(each.first for each in stay))
        who = _say_commands(numbers)
        message = f"{_capital(definite(_name(place)))} is visited once for {who}."
        if isinstance(place, Operator):
            message = f"The robot comes back to you once for {who}."
        yield Interleaving(Reason.SHARED_VISIT, numbers, steps, message)


def _same_room(one: _Stop, other: _Stop) -> Iterator[Interleaving]:
    commands = tuple(sorted({one.command, other.command}))
    room = _room(one.place)
    if len(commands) > 1 and room and room == _room(other.place):
        message = (
            f"{_capital(definite(_name(one.place)))} and {definite(_name(other.place))} are in one room, so "
            f"{_say_commands(commands)} follow each other there."
        )
        yield Interleaving(Reason.SAME_ROOM, commands, (one.first, other.first), message)


def _say_commands(commands: Sequence[int]) -> str:
    *first, last = map(str, commands)
    return f"commands {', '.join(first)} and {last}"


def _mover(book: RecipeBook) -> Primitive | None:
    """Return the primitive that only brings the robot to a place; None if the book has none."""
    for each in book.primitives:
        moves = each.effect(EffectKind.MOVES)
        needed = {parameter.name for parameter in each.parameters if not parameter.is_optional}
        if moves is not None and len(each.effects) == 1 and needed == {moves.subject}:
            return each
    return None


def _has(step: TaskStep, *kinds: EffectKind) -> bool:
    return any(effect.kind in kinds for effect in step.primitive.effects)


def _place(step: TaskStep, before: Place) -> Place:
    """Return where the robot is after a step; ``before`` is where it was."""
    if not _has(step, EffectKind.MOVES, EffectKind.ACCOMPANIES):
        return before
    return Somewhere(step.number) if step.place is None else step.place


def _name(place: Place) -> str:
    if isinstance(place, Operator):
        return OPERATOR_WORD
    text = "" if isinstance(place, Somewhere) else str(place.as_json().get("text", ""))
    return text.removeprefix("the ")


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def _room(place: Place) -> str:
    """Return the room of a place; a room is its own, and that of others may be unknown."""
    if not isinstance(place, Named):
        return ""
    return place.text if place.entity_class == ROOM_CLASS else place.attributes.get("room", "")
