"""What a change of templates or of their grammar does to the commands: the difference of two generations."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

from annotations.language.templates.expansion import (
    Conflict,
    Expansion,
    Generated,
    LeftOut,
    TaskCategory,
)

Row = TypeVar("Row")

# A name of a template that stays the same while the template changes, such as its primary key.
Name = Hashable


@dataclass(frozen=True)
class GeneratedState:
    """What the templates of task categories make.

    ``names`` are task category → the names of its templates, in the order of ``TaskCategory.templates``.
    """

    categories: Sequence[TaskCategory]
    generated: Generated
    names: Mapping[str, Sequence[Name]]

    def name(self, place: tuple[str, int]) -> Name:
        """Return the name of the template at (task category, template index)."""
        task_category, index = place
        return self.names[task_category][index]


@dataclass(frozen=True, slots=True)
class ChangedForm:
    """A command that gets another form; both are canonical texts."""

    command: str
    before: str
    after: str


@dataclass(frozen=True, slots=True)
class DuplicateTemplate:
    """``template`` says the same as ``earlier``, which stands before it in a task category."""

    template: Name
    earlier: Name


@dataclass(frozen=True, slots=True)
class Shadowed:
    """All commands of ``template`` are taken by other templates; ``by`` takes the first of them."""

    template: Name
    by: Name


@dataclass(frozen=True)
class Consequences:
    """What is different after a change. Commands come in their order; nothing is counted twice.

    ``covered`` are commands that had no form before, ``lost`` those that have none any more.
    ``duplicates``, ``shadowed`` and ``left_out`` are only those that the change brings about.
    """

    covered: tuple[Expansion, ...] = ()
    lost: tuple[Expansion, ...] = ()
    changed: tuple[ChangedForm, ...] = ()
    conflicts: tuple[Conflict, ...] = ()
    conflicts_gone: tuple[Conflict, ...] = ()
    duplicates: tuple[DuplicateTemplate, ...] = ()
    shadowed: tuple[Shadowed, ...] = ()
    left_out: tuple[LeftOut, ...] = ()

    @property
    def covered_in_grammar(self) -> tuple[Expansion, ...]:
        """Those newly covered that the grammar makes too."""
        return tuple(each for each in self.covered if each.in_grammar)

    @property
    def covered_outside(self) -> tuple[Expansion, ...]:
        """Those that only the templates make."""
        return tuple(each for each in self.covered if not each.in_grammar)

    @property
    def is_none(self) -> bool:
        """Whether commands and templates stay as they are."""
        return self == Consequences()


def consequences_of(before: GeneratedState, after: GeneratedState) -> Consequences:
    """Return the difference of two generations of the same task categories."""
    old = {each.command: each for each in before.generated.expansions}
    new = {each.command: each for each in after.generated.expansions}
    old_conflicts, new_conflicts = _conflicts(before), _conflicts(after)
    return Consequences(
        covered=tuple(each for command, each in new.items() if command not in old),
        lost=tuple(each for command, each in old.items() if command not in new),
        changed=tuple(
            ChangedForm(command, old[command].form_text, each.form_text)
            for command, each in new.items()
            if command in old and old[command].form_text != each.form_text
        ),
        conflicts=_find_added(old_conflicts, new_conflicts),
        conflicts_gone=_find_added(new_conflicts, old_conflicts),
        duplicates=_find_added(_duplicates(before), _duplicates(after)),
        shadowed=_find_added(_find_shadowed(before), _find_shadowed(after)),
        left_out=_find_added(_index_left_out(before), _index_left_out(after)),
    )


def _conflicts(state: GeneratedState) -> dict[Hashable, Conflict]:
    """Return the conflicts by what they say: the same forms for the same command, whichever templates give them."""
    return {
        (each.task_category, each.command, tuple(form for _, form in each.candidates)): each
        for each in state.generated.conflicts
    }


def _find_added(before: Mapping[Name, Row], after: Mapping[Name, Row]) -> tuple[Row, ...]:
    return tuple(each for name, each in after.items() if name not in before)


def _duplicates(state: GeneratedState) -> dict[Name, DuplicateTemplate]:
    duplicates: dict[Name, DuplicateTemplate] = {}
    for category in state.categories:
        first: dict[object, Name] = {}
        for name, template in zip(state.names[category.name], category.templates, strict=True):
            earlier = first.setdefault((template.pattern_text, template.form_text), name)
            if earlier != name:
                duplicates[name] = DuplicateTemplate(name, earlier)
    return duplicates


def _find_shadowed(state: GeneratedState) -> dict[Name, Shadowed]:
    """Return the templates that make commands, none of which is theirs in any task category."""
    generated = state.generated
    winners = {each.command: each for each in generated.expansions}
    winning = {state.name(_place(each)) for each in generated.expansions}
    shadowed: dict[Name, Shadowed] = {}
    for place, commands in generated.commands_by_template.items():
        name = state.name(place)
        if name not in winning and name not in shadowed and commands:
            winner = winners[next(iter(commands))]
            shadowed[name] = Shadowed(name, state.name(_place(winner)))
    return shadowed


def _index_left_out(state: GeneratedState) -> dict[Name, LeftOut]:
    return {
        state.name((each.task_category, each.template_index)): each
        for each in state.generated.left_out
    }


def _place(expansion: Expansion) -> tuple[str, int]:
    return expansion.task_category, expansion.template_index
