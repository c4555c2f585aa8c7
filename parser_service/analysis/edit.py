"""An edit of an utterance, and what it does to the form."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum

from annotations.language.forms import Application, Constant, Form, Lambda


class EditKind(StrEnum):
    """What is edited. The first five keep what is meant, the others change it in a known way."""

    ENTITY = "entity"
    POLITENESS = "politeness"
    ARTICLE = "article"
    SPELLING = "spelling"
    SYNONYM = "synonym"
    RECIPIENT = "recipient"
    PLACE = "place"
    CLASS = "class"

    @property
    def keeps_meaning(self) -> bool:
        """Whether a form with class tokens stays as it is."""
        return self not in (EditKind.RECIPIENT, EditKind.PLACE, EditKind.CLASS)


@dataclass(frozen=True, slots=True)
class UtteranceEdit:
    """``text`` is the utterance with ``new`` in place of ``old`` (either may be empty); ``form`` is what
    it must be parsed to."""

    kind: EditKind
    text: str
    form: Form
    old: str
    new: str


def substitute(form: Form, old: Constant, new: Constant) -> Form:
    """Return the form with ``new`` wherever it has ``old``."""
    if form == old:
        return new
    if isinstance(form, Lambda):
        return replace(form, bodies=tuple(substitute(body, old, new) for body in form.bodies))
    if isinstance(form, Application):
        arguments = tuple(substitute(each, old, new) for each in form.arguments)
        return replace(form, arguments=arguments)
    return form
