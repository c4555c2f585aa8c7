"""The rows of a recipe book: primitives of a robot, and recipes that do an action of a form with them."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TypeAlias

from annotations.language.texts import Position

# The left side of the recipe for what a robot does when all commands are done; no form has this action.
AFTER_COMMANDS = "after_commands"
OPERATOR_WORD = "operator"  # stands for the person who gave the command, and for where they are


class EffectKind(StrEnum):
    """What a primitive does to the world, in the words of its row."""

    MOVES = "moves"  # the robot is at a place
    FINDS = "finds"  # something or somebody is known to be where the robot is
    TAKES = "takes"  # a thing is in the gripper
    RELEASES = "releases"  # the thing in the gripper is somewhere, or with somebody
    ACCOMPANIES = "accompanies"  # the robot and a person are at a place, or where the person leads
    LEARNS = "learns"  # there is a result that later steps can use
    SPEAKS = "speaks"  # somebody has heard something, or the robot has
    ACTS = "acts"  # a thing that is here is not as it was: open, clean


# ``{thing}`` in a pattern, and ``{things:plural}``.
PLACEHOLDER = re.compile(r"\{(?P<name>[^{}:]*)(?P<is_plural>:plural)?\}")
# Effects that last: a primitive that has no others is left out where they hold already.
LASTING = frozenset((EffectKind.MOVES, EffectKind.FINDS, EffectKind.TAKES))


@dataclass(frozen=True, slots=True)
class Effect:
    """One effect of a primitive.

    ``subject`` is the parameter that it is about; empty for what a robot says to nobody and for what it
    learns. ``target`` is the parameter that says where or to whom, after ``preposition``. ``noun`` says in
    English what is learnt: ``the number of {things:plural}``.
    """

    kind: EffectKind
    subject: str = ""
    preposition: str = ""
    target: str = ""
    noun: str = ""

    def __str__(self) -> str:
        to = {EffectKind.MOVES: "to ", EffectKind.SPEAKS: "to ", EffectKind.ACTS: "on "}
        words = [str(self.kind)]
        if self.subject:
            words.append(f"{to.get(self.kind, '')}{self.subject}")
        if self.target:
            words.append(f"{self.preposition} {self.target}")
        if self.noun:
            words.append(quoted(self.noun))
        return " ".join(words)


@dataclass(frozen=True, slots=True)
class PrimitiveParameter:
    """A parameter of a primitive."""

    name: str
    is_optional: bool = False

    def __str__(self) -> str:
        return f"{self.name}?" if self.is_optional else self.name


@dataclass(frozen=True, slots=True)
class Primitive:
    """Something that a team's robot can do.

    ``said`` are patterns for saying it in English; the fullest one whose parameters are all there is used.
    """

    name: str
    parameters: tuple[PrimitiveParameter, ...] = ()
    said: tuple[str, ...] = ()
    effects: tuple[Effect, ...] = ()
    position: Position = field(default_factory=Position, compare=False)

    @property
    def gives_result(self) -> bool:
        return self.effect(EffectKind.LEARNS) is not None

    def effect(self, kind: EffectKind) -> Effect | None:
        """Return the effect of a kind; a primitive has at most one."""
        return next((each for each in self.effects if each.kind is kind), None)

    def __str__(self) -> str:
        """Return the row as text; ``read_primitive`` reads it back."""
        text = f"{self.name}({', '.join(map(str, self.parameters))})"
        if self.said:
            text += f" {quoted(' | '.join(self.said))}"
        if self.effects:
            text += f": {', '.join(map(str, self.effects))}"
        return text


@dataclass(frozen=True, slots=True)
class Parameter:
    """An argument of an action as a recipe expects it.

    ``kind`` restricts its value: ``person``, ``thing``, ``place``, ``attribute``, ``text``, ``number``,
    ``result``, or the token of an entity class. An ``action`` in its place stands for the result of
    another action, which the recipe does as well.
    """

    name: str
    kind: str = ""
    action: ActionPattern | None = None

    def __str__(self) -> str:
        kind = str(self.action) if self.action else self.kind
        return f"{self.name}: {kind}" if kind else self.name


@dataclass(frozen=True, slots=True)
class ActionPattern:
    """The left side of a recipe: an action of a form and all of its arguments."""

    action: str
    parameters: tuple[Parameter, ...] = ()

    def __str__(self) -> str:
        return f"{self.action}({', '.join(map(str, self.parameters))})"

    def names(self) -> tuple[str, ...]:
        """Return what the right side can use; an argument that is an action stands for those of the action."""
        names: list[str] = []
        for each in self.parameters:
            names += each.action.names() if each.action else (each.name,)
        return tuple(names)

    @property
    def restrictions(self) -> int:
        """How many arguments have to be of a kind: the recipe with the most fits best."""
        return sum(
            1 + each.action.restrictions if each.action else bool(each.kind)
            for each in self.parameters
        )

    def shape(self) -> tuple[object, ...]:
        """Return what two patterns that fit the same actions have in common."""
        return (
            self.action,
            frozenset(
                (each.name, each.kind, each.action.shape() if each.action else None)
                for each in self.parameters
            ),
        )


class Part(StrEnum):
    """What ``… of NAME`` takes of a value."""

    PLACE = "place"  # where it is; a place is where it is itself
    OWNER = "owner"  # the person of "the name of the person"
    ATTRIBUTE = "attribute"  # the word "name" of it


@dataclass(frozen=True, slots=True)
class Name:
    """An argument of the left side, or the result of an earlier primitive, or a part of it."""

    name: str
    part: Part | None = None
    position: Position = field(default_factory=Position, compare=False)

    def __str__(self) -> str:
        return f"{self.part} of {self.name}" if self.part else self.name


@dataclass(frozen=True, slots=True)
class Literal:
    """A text in quotation marks."""

    text: str

    def __str__(self) -> str:
        return quoted(self.text)


@dataclass(frozen=True, slots=True)
class TheOperator:
    """The word ``operator``."""

    def __str__(self) -> str:
        return OPERATOR_WORD


Argument: TypeAlias = Name | Literal | TheOperator


@dataclass(frozen=True, slots=True)
class Call:
    """One primitive on the right side; ``result`` is the name that its result has in this recipe."""

    primitive: str
    arguments: tuple[Argument, ...] = ()
    result: str = ""
    position: Position = field(default_factory=Position, compare=False)

    def __str__(self) -> str:
        text = f"{self.primitive}({', '.join(map(str, self.arguments))})"
        return f"{self.result} = {text}" if self.result else text


@dataclass(frozen=True, slots=True)
class Recipe:
    """How one action of a form is done: primitives in order."""

    pattern: ActionPattern
    calls: tuple[Call, ...]
    position: Position = field(default_factory=Position, compare=False)

    def __str__(self) -> str:
        """Return the row as text; ``read_recipe`` reads it back."""
        return f"{self.pattern} -> {' '.join(map(str, self.calls))}"


def quoted(text: str) -> str:
    """Return a text in the quotation marks of a row."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'
