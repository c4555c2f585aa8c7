"""What the arguments of actions are called, by place and kind: data for plans."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from annotations.language.forms import Application, Form, Lambda, Unknown, walk
from annotations.language.predicates import ArgumentKind, argument_kind

THING, PERSON, PLACE, TEXT = "thing", "person", "destination", "text"
# Action → the names of its arguments by place; a name by kind where an action takes several kinds there.
_NAMES: Mapping[str, Sequence[Mapping[str, str] | str]] = {
    "bring": (THING, {"person": "recipient", "place": "source", "": "recipient"}),
    "put": (THING, PLACE),
    "pour": (THING, PLACE),
    "take": (THING, {"place": "source", "": PLACE}),
    "find": ("target", {"number": "count", "": "where"}),
    "follow": (PERSON, PLACE),
    "guide": (PERSON, PLACE),
    "meet": (PERSON, "where"),
    "greet": (PERSON, "where"),
    "introduce": (PERSON, "to"),
    "go": (PLACE,),
    "clear": ("where",),
    "wait": ({"place": "where", "": PERSON}, "where"),
    "open": (THING,),
    "close": (THING,),
    "count": ("things",),
    "answer": ("question", "asker"),
    "say": ({"thing": "about", "person": "about", "": TEXT}, "listener"),
}
_PLACES = frozenset((ArgumentKind.LOCATION, ArgumentKind.ROOM))
_OF_A_PERSON = frozenset(("person", "name", "male", "female", "gesture", "pose", "gender"))
# Actions that make no sense without these arguments.
NEEDED: Mapping[str, Sequence[str]] = {
    "guide": (PLACE,),
    "go": (PLACE,),
    "put": (PLACE,),
    "bring": (THING,),
}
QUESTIONS = {
    PLACE: "Where to?",
    "source": "From where?",
    THING: "Which thing?",
    PERSON: "Which person?",
    "recipient": "For whom?",
    "listener": "To whom?",
    TEXT: "What shall I say?",
    "question": "Which question?",
    "where": "Where?",
}


def argument_name(action: str, place: int, argument: Form, entity_class: str = "") -> str:
    """Return the name of an argument: ``destination`` for the second one of ``guide``.

    ``entity_class`` is that of a text that names an entity. An action that is not known calls its
    arguments ``argument_1``, ``argument_2``, ….
    """
    names = _NAMES.get(action, ())
    if place >= len(names):
        return f"argument_{place + 1}"
    name = names[place]
    return name if isinstance(name, str) else name.get(_kind(argument, entity_class), name[""])


def question_of(name: str) -> str:
    """Return what to ask the operator for an argument that a command leaves open."""
    return QUESTIONS.get(name, f"What is the {name.replace('_', ' ')}?")


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
