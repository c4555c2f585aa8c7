"""What may be the name of something: LanguageError says what is wrong with others, in a sentence."""

from __future__ import annotations

import re

from annotations.language.errors import LanguageError, Position
from annotations.language.forms import Application, read_form
from annotations.language.limits import (
    MAX_ENTITY,
    MAX_NONTERMINAL,
    MAX_PREDICATE,
    require_name,
    require_writable,
)

_NONTERMINAL = re.compile(r"[^\W\d]\w*")
_PREDICATE = re.compile(r"[^\W\d][\w-]*")
# They mark class tokens, wildcards, texts and lists of names.
_RESERVED = re.compile(r'[<>{}"|\n\r\t]')


def require_nonterminal(name: str) -> None:
    """Raise LanguageError unless ``$name`` is a nonterminal; ``name`` is without the dollar sign."""
    if not _NONTERMINAL.fullmatch(name):
        raise LanguageError(
            f"{name or 'an empty text'} is not the name of a nonterminal",
            hint="use letters, digits and _, with a letter or _ first",
        )
    require_name(name, "nonterminal", MAX_NONTERMINAL, Position())


def require_predicate(name: str) -> None:
    """Raise LanguageError unless ``name`` reads as a predicate in every notation."""
    hint = "use letters, digits, _ and -, with a letter first"
    if not _PREDICATE.fullmatch(name):
        raise LanguageError(f"{name or 'an empty text'} is not the name of a predicate", hint=hint)
    require_name(name, "predicate", MAX_PREDICATE, Position())
    for text in (f'({name} "a")', f'{name}("a")'):
        try:
            form = read_form(text)
        except LanguageError:
            form = None
        if not (isinstance(form, Application) and form.predicate == name):
            raise LanguageError(
                f"{name} means something else in a form", hint="choose another name"
            )


def require_entity_name(name: str) -> None:
    """Raise LanguageError unless an entity can be called ``name``."""
    if not name.strip():
        raise LanguageError("the name is empty", hint="write what people call it")
    if reserved := _RESERVED.search(name):
        raise LanguageError(
            f"a name cannot have the character {reserved[0]!r}", hint="write it without"
        )
    require_name(name, "name", MAX_ENTITY, Position())
    require_writable(name, Position())
