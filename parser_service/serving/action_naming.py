"""Read and write what the robot of a world calls its actions and their arguments."""

from __future__ import annotations

import re
from collections.abc import Mapping
from http import HTTPStatus

from django.db import IntegrityError, transaction
from django.utils import timezone

from annotations.language.plans import ASK, TAKEN_NAMES, ActionName
from annotations.language.texts import Refusal
from annotations.models import Predicate, User, World
from parser_service.models import ActionNames

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,79}")
_PAIR = re.compile(r"\s*([a-z0-9_]+)\s*=\s*(\S+)\s*")
_RESERVED = ("name", "id", "result")


def actions_of(world: World) -> list[str]:
    """Return the predicates of a world that are actions, then ``ask_operator``."""
    rows = Predicate.objects.filter(world=world, kind="action")
    return [*rows.order_by("name").values_list("name", flat=True), ASK]


def names_of(world: World) -> dict[str, ActionName]:
    """Return what the robot calls the actions that have a name of their own."""
    row = ActionNames.objects.filter(world=world).first()
    names = row.names if row else {}
    return {
        action: ActionName(value["name"], dict(value["arguments"]))
        for action, value in names.items()
    }


def version_of(world: World) -> int:
    """Return the version of the names; 0 where nobody has given any."""
    row = ActionNames.objects.filter(world=world).only("version").first()
    return row.version if row else 0


def store_names(world: World, names: Mapping[str, ActionName], by: User, version: int) -> None:
    """Store the names of all actions, which ``by`` edited while they were at ``version``.

    Raises Refusal where they have changed since.
    """
    values = {
        "names": {
            action: {"name": each.name, "arguments": dict(each.arguments)}
            for action, each in names.items()
        },
        "version": version + 1,
        "changed_by": by,
        "changed_at": timezone.now(),
    }
    try:
        with transaction.atomic():
            if not version:
                ActionNames.objects.create(world=world, **values)
                return
            rows = ActionNames.objects.filter(world=world, version=version)
            is_stored = bool(rows.update(**values))
    except IntegrityError:
        is_stored = False
    if not is_stored:
        sentence = "Somebody has changed the names meanwhile. Load the page again."
        raise Refusal(sentence, "names_changed_meanwhile", HTTPStatus.CONFLICT)


def read_name(action: str, name: str, arguments: str) -> ActionName | None:
    """Return what somebody wrote for an action: its name, and ``thing=object, destination=goal``.

    None where the robot calls it as the world does. Raises Refusal.
    """
    name = name.strip() or action
    if name != action:
        _require_name(name)
        if name in TAKEN_NAMES:
            sentence = f"BehaviorTree.CPP has a “{name}” of its own. Choose another name."
            raise Refusal(sentence, "taken_robot_name")
    renamed: dict[str, str] = {}
    for part in filter(str.strip, arguments.split(",")):
        pair = _PAIR.fullmatch(part)
        if pair is None:
            raise Refusal(f"“{part.strip()}” is no pair such as destination=goal.", "not_a_pair")
        _require_name(pair[2])
        if pair[1] in renamed or pair[2] in renamed.values():
            raise Refusal(f"“{part.strip()}” is there twice.", "argument_twice")
        renamed[pair[1]] = pair[2]
    return ActionName(name, renamed) if renamed or name != action else None


def write_arguments(name: ActionName) -> str:
    """Return the names of arguments as ``read_name`` reads them."""
    return ", ".join(f"{argument}={its}" for argument, its in sorted(name.arguments.items()))


def is_name(name: str) -> bool:
    """Return whether a robot can have this name for something."""
    return bool(NAME.fullmatch(name)) and name.casefold() not in _RESERVED


def _require_name(name: str) -> None:
    if not is_name(name):
        raise Refusal(
            f"“{name}” is no name for a robot: letters, digits and _, a letter first, "
            f"and none of {', '.join(_RESERVED)}.",
            "not_a_robot_name",
        )
