"""Normalises the texts of a request, whatever form they came in, and remembers what that changed."""

from __future__ import annotations

from typing import Any

from django.http import HttpRequest, QueryDict

from annotations.language.texts import (
    MAX_NESTING,
    Refusal,
    TextChanges,
    has_half_character,
    normalise,
)

MOST_NAMED = 20  # fields in a header or a message
LONGEST_FIELD = 200  # characters of the name of a field: each value in a long list has one


class NotText(Refusal):
    """A value of a request is not valid text. ``field`` names it; the message is a sentence."""

    code = "not_text"

    def __init__(self, field: str, sentence: str) -> None:
        self.field = field[:LONGEST_FIELD].encode("utf-8", "replace").decode()
        where = {"field": self.field} if self.field else {}
        super().__init__(sentence, problems=[{**where, "message": sentence}])


class SentTexts:
    """Reads and normalises what was sent. ``changes`` says, by field, what normalising changed.

    Passwords stay as they are: one that was set with another keyboard has to keep working.
    """

    def __init__(self) -> None:
        self.changes: dict[str, TextChanges] = {}

    def read_form(self, sent: QueryDict) -> QueryDict:
        """Return the fields of a form, or of a query."""
        clean = QueryDict(mutable=True, encoding=sent.encoding)
        for name, values in sent.lists():
            clean.setlist(normalise(name), [self._read_text(each, name) for each in values])
        clean._mutable = False
        return clean

    def read_json(self, value: Any, field: str = "", depth: int = 0) -> Any:
        """Return a value of parsed JSON. Raises NotText where it nests too deep, or is no text."""
        if depth > MAX_NESTING:
            sentence = f"The JSON nests too deep; {MAX_NESTING} levels is the limit."
            raise NotText(field.partition(".")[0], sentence)
        match value:
            case str():
                _require_text(value, field)
                return self._read_text(value, field)
            case list():
                places = ((_below(field, place), each) for place, each in enumerate(value))
                return [self.read_json(each, place, depth + 1) for place, each in places]
            case dict():
                for name in value:
                    _require_text(name, _below(field, name))
                return {
                    normalise(name): self.read_json(each, _below(field, name), depth + 1)
                    for name, each in value.items()
                }
        return value

    def _read_text(self, text: str, field: str) -> str:
        if "password" in field:
            return text
        if changes := TextChanges.of(text):
            name = field[:LONGEST_FIELD]
            self.changes[name] = self.changes.get(name, TextChanges()) + changes
        return normalise(text)

    def __str__(self) -> str:
        """Say what was changed in which field; empty where nothing was."""
        named = [f"{field}: {changes}" for field, changes in self.changes.items()]
        rest = [f"and {len(named) - MOST_NAMED} more fields"] if len(named) > MOST_NAMED else []
        return "; ".join([*named[:MOST_NAMED], *rest])


def sent_texts_of(request: HttpRequest) -> SentTexts:
    """Return the reader of the texts of this request; all its parts share one."""
    kept: Any = request  # a request keeps what is set on it
    if not hasattr(kept, "sent_texts"):
        kept.sent_texts = SentTexts()
    texts: SentTexts = kept.sent_texts
    return texts


def _below(field: str, name: str | int) -> str:
    """Return the name of ``name`` inside ``field``, joined by a dot."""
    return f"{field}.{str(name)[:LONGEST_FIELD]}".strip(".")[:LONGEST_FIELD]


def _require_text(text: str, field: str) -> None:
    if has_half_character(text):
        sentence = "This text holds half a character, a lone surrogate such as \\ud83d."
        raise NotText(field, sentence)
    if "\0" in text:
        raise NotText(field, "This text holds a NUL character, which is not allowed.")
