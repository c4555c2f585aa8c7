"""Why a text is no logical form: lark's findings as sentences with a place and a hint."""

from __future__ import annotations

from lark import Token, UnexpectedCharacters, UnexpectedInput

from annotations.language.errors import LanguageError, Position

_SHOWN = 40
_BRACKETS = {
    '"': ("quotation mark", '"'),
    "{": ("brace", "}"),
    "<": ("angle bracket", ">"),
    "⟨": ("angle bracket", "⟩"),
}
_EXAMPLE = 'write a form like (find (λ$1:e (is_a $1 "cereal")))'


def explained(error: UnexpectedInput, text: str) -> LanguageError:
    """What lark met, as a sentence with the place and what to do."""
    if not text.strip():
        return LanguageError("there is no form here", Position(), "write one, or UNKNOWN")
    offset = error.pos_in_stream or 0
    place = place_of(text, offset)
    if isinstance(error, UnexpectedCharacters):
        return _unreadable(text, offset, place)
    token: Token = error.token  # type: ignore[attr-defined]
    if token.type == "$END":
        end = place_of(text, len(text.rstrip()))
        return LanguageError("the form ends too early", end, "close every parenthesis")
    found = token if len(token) <= _SHOWN else f"{token[:_SHOWN]}…"
    if not error.expected:  # type: ignore[attr-defined]
        return LanguageError(f"{found} follows the end of the form", place, "remove it")
    is_class = token.type == "CLASS_TOKEN"
    hint = f'put it in quotation marks: "{found}"' if is_class else _EXAMPLE
    return LanguageError(f"{found} cannot stand here", place, hint)


def _unreadable(text: str, offset: int, place: Position) -> LanguageError:
    """What the character at ``offset`` is, where no token begins."""
    found = text[offset]
    name, closing = _BRACKETS.get(found, ("", ""))
    if name and closing not in text[offset + 1 :]:
        return LanguageError(f"the {name} {found} is not closed", place, "close it")
    return LanguageError(f"{found} cannot stand here", place, _EXAMPLE)


def place_of(text: str, offset: int) -> Position:
    """The position of the character at ``offset`` of a text."""
    before = text[:offset]
    return Position("", before.count("\n") + 1, offset - (before.rfind("\n") + 1) + 1)
