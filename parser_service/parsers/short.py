"""A shorter notation of forms that can be read back, with a fifth of the corpus tokens.

``( bring ( lambda $1 e ( is_a $1 " <object> " ) ( at $1 " <room> " ) ) )`` is
``(bring L1 is_a:$1:<object> at:$1:<room>``. An application without λs and applications inside is
one token; closing parentheses at the end are left out. Two forms that differ in one such token
differ in one part of their meaning, which is what augmentation exchanges.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from urllib.parse import quote, unquote

from annotations.language.forms import (
    UNKNOWN,
    Application,
    Constant,
    Form,
    Lambda,
    Reference,
    Unknown,
    Variable,
    children,
)

CLOSE = ")"
_PLAIN = "<>'"  # beside letters, digits and _.-~, what stands in a token as it is


def shorten(form: Form) -> tuple[str, ...]:
    """Return the short tokens of a form. Raises ValueError for a form with slots of a template."""
    tokens = list(_tokens(form))
    while tokens[-1] == CLOSE:
        tokens.pop()
    return tuple(tokens)


def lengthen(tokens: Sequence[str]) -> Form:
    """Return the form that ``shorten`` wrote. Raises ValueError for tokens that are not a form."""
    waiting = list(reversed(tokens))
    try:
        form = _read(waiting)
    except (IndexError, ValueError):
        waiting = [""]
    if waiting:
        raise ValueError(f"{' '.join(tokens)} is not a form.")
    return form


def name_of(token: str) -> str:
    """Return the predicate that a token names; empty where it names none."""
    if token.startswith("("):
        return unquote(token[1:])
    return unquote(token.partition(":")[0]) if is_leaf_application(token) else ""


def is_leaf_application(token: str) -> bool:
    """Return whether a token is a whole application, as ``at:$1:<room>``."""
    return ":" in token


def _tokens(form: Form) -> Iterator[str]:
    if isinstance(form, Lambda):
        yield f"L{form.variable}" if form.type == "e" else f"L{form.variable}/{_quote(form.type)}"
    elif not isinstance(form, Application):
        yield _leaf(form, '"')
        return
    elif form.arguments and not any(
        isinstance(each, Lambda | Application) for each in form.arguments
    ):
        leaves = (_leaf(argument, "") for argument in form.arguments)
        yield ":".join((_quote(str(form.predicate)), *leaves))
        return
    else:
        yield f"({_quote(str(form.predicate))}"
    for child in children(form):
        yield from _tokens(child)
    yield CLOSE


def _leaf(form: Form, mark: str) -> str:
    """Write a leaf; ``mark`` comes before a text that is a token of its own."""
    if isinstance(form, Variable):
        return f"${form.index}"
    if isinstance(form, Unknown):
        return "?"
    if isinstance(form, Reference):
        return f"&{form.word}"
    if isinstance(form, Constant):
        is_number = isinstance(form.value, int)
        return f"#{form.value}" if is_number else f"{mark}{_quote(str(form.value))}"
    raise ValueError(f"{form} is a slot of a template; only whole forms have a short spelling.")


def _quote(text: str) -> str:
    return quote(text, safe=_PLAIN)


def _read(waiting: list[str]) -> Form:
    token = waiting.pop()
    if token.startswith("("):
        return Application(unquote(token[1:]), _read_until_close(waiting))
    if token.startswith(("$", "?", "&", "#", '"')):
        return _read_leaf(token.removeprefix('"'))
    if ":" in token:
        name, *leaves = token.split(":")
        return Application(unquote(name), tuple(map(_read_leaf, leaves)))
    variable, _, type_ = token.removeprefix("L").partition("/")
    return Lambda(int(variable), unquote(type_) or "e", _read_until_close(waiting))


def _read_until_close(waiting: list[str]) -> tuple[Form, ...]:
    """Read what an open parenthesis holds; the end of the tokens closes it, too."""
    parts = []
    while waiting and waiting[-1] != CLOSE:
        parts.append(_read(waiting))
    if waiting:
        waiting.pop()
    return tuple(parts)


def _read_leaf(token: str) -> Form:
    if token.startswith("$"):
        return Variable(int(token[1:]))
    if token == "?":
        return UNKNOWN
    if token.startswith("&"):
        return Reference(token[1:])
    return Constant(int(token[1:])) if token.startswith("#") else Constant(unquote(token))
