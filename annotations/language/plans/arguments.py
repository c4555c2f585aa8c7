"""What the arguments of actions are called in plans, by place and kind."""

from __future__ import annotations

from annotations.language.english import ARGUMENT_NAMES, ARGUMENT_QUESTIONS
from annotations.language.forms import Application, Form, Lambda, Unknown, walk
from annotations.language.predicates import ArgumentKind, argument_kind

_PLACES = frozenset((ArgumentKind.LOCATION, ArgumentKind.ROOM))
_OF_A_PERSON = frozenset(("person", "name", "male", "female", "gesture", "pose", "gender"))


def argument_name(action: str, place: int, argument: Form, entity_class: str = "") -> str:
    """Return the name of an argument: ``destination`` for the second one of ``guide``.

    ``entity_class`` is that of a text that names an entity. An action that is not known calls its
    arguments ``argument_1``, ``argument_2``, ….
    """
    names = ARGUMENT_NAMES.get(action, ())
    if place >= len(names):
        return f"argument_{place + 1}"
    name = names[place]
    if isinstance(name, str):
        return name
    return name.get(_kind(argument, entity_class)) or name.get("") or f"argument_{place + 1}"


def question_of(name: str) -> str:
    """Return what to ask the operator for an argument that a command leaves open."""
    return ARGUMENT_QUESTIONS.get(name, f"What is the {name.replace('_', ' ')}?")


def _kind(argument: Form, entity_class: str) -> str:
    kind = argument_kind(argument)
    if kind in _PLACES or entity_class in ("location", "room"):
        return "place"
    if kind is ArgumentKind.NUMBER or isinstance(argument, Unknown):
        return "number" if kind is ArgumentKind.NUMBER else "unknown"
    if not isinstance(argument, Lambda):
        return "name" if kind is ArgumentKind.NAME or entity_class == "name" else "text"
    names = {node.predicate for node in walk(argument) if isinstance(node, Application)}
    return "person" if names & _OF_A_PERSON else "thing"
