"""Explain why a text is not a logical form: lark's errors as sentences with a place and a hint."""

from __future__ import annotations

from lark import Token, UnexpectedCharacters, UnexpectedInput

from annotations.language.errors import LanguageError, Offsets, Position

_SHOWN = 40
_BRACKETS = {
    '"': ("quotation mark", '"'),
    "{": ("brace", "}"),
    "<": ("angle bracket", ">"),
    "⟨": ("angle bracket", "⟩"),
}
_EXAMPLE = 'write a form like (find (λ$1:e (is_a $1 "cereal")))'


def explain(error: UnexpectedInput, text: str) -> LanguageError:
    """Return lark's error as a sentence with the place and what to do."""
    if not text.strip():
        return LanguageError("there is no form here", Position(), "write one, or UNKNOWN")
    offset = error.pos_in_stream or 0
    place = Offsets(text).position(offset)
    if isinstance(error, UnexpectedCharacters):
        return _explain_character(text, offset, place)
    token: Token = error.token  # type: ignore[attr-defined]
    if token.type == "$END":
        end = Offsets(text).position(len(text.rstrip()))
        return LanguageError("the form ends too early", end, "close every parenthesis")
    shown = token if len(token) <= _SHOWN else f"{token[:_SHOWN]}…"
    if not error.expected:  # type: ignore[attr-defined]
        return LanguageError(f"{shown} follows the end of the form", place, "remove it")
    is_class = token.type == "CLASS_TOKEN"
    hint = f'put it in quotation marks: "{shown}"' if is_class else _EXAMPLE
    return LanguageError(f"{shown} is not allowed here", place, hint)


def _explain_character(text: str, offset: int, place: Position) -> LanguageError:
    """Explain the character at ``offset``, where no token begins."""
    character = text[offset]
    name, closing = _BRACKETS.get(character, ("", ""))
    if name and closing not in text[offset + 1 :]:
        return LanguageError(f"the {name} {character} is not closed", place, "close it")
    return LanguageError(f"{character} is not allowed here", place, _EXAMPLE)
