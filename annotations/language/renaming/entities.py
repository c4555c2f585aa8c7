"""Rename an entity where it is named: as a span of an utterance, in a form, in a condition of a wildcard."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace

from annotations.language.errors import LanguageError
from annotations.language.forms import (
    Application,
    Constant,
    Form,
    Lambda,
    children,
    read_form,
    read_spans,
    to_corpus,
)
from annotations.language.grounding import Anonymizer
from annotations.language.renaming.texts import replace_parts
from annotations.language.symbols import Wildcard, places_in_form, places_in_pattern

# The attributes that name another entity → its class.
CLASS_OF_ATTRIBUTE = {"category": "category", "room": "room", "defaultlocation": "location"}
_CONDITION = re.compile(r'(?P<property>\w+)\s*(?:!=|=)\s*"(?P<value>[^"{}]*)"')


@dataclass(frozen=True, slots=True)
class EntityName:
    """A spelling of an entity of a class: its text, or an alias."""

    entity_class: str
    text: str

    def is_written(self, words: str) -> bool:
        """Return whether ``words`` are this name, ignoring case and spacing."""
        return _plain(words) == _plain(self.text)


def rename_in_utterance(text: str, name: EntityName, new: str, anonymizer: Anonymizer) -> str:
    """Return ``text`` with ``new`` for each span that names an entity of the class by ``name``.

    ``anonymizer`` knows the entity by the old name. Plurals and other spellings stay.
    """
    spans = anonymizer.anonymize(text).spans
    parts = (
        (span.start, span.end)
        for span in spans
        if span.entity_class == name.entity_class and name.is_written(text[span.start : span.end])
    )
    return replace_parts(text, parts, new)


def rename_in_grounded_form(grounded: str, anonymized: str, name: EntityName, new: str) -> str:
    """Return the corpus text ``grounded`` with ``new`` for ``name``.

    Only a text in whose place ``anonymized``, the same form with class tokens, has a token of the class is
    renamed. Forms that cannot be read, or are not the same, stay as they are.
    """
    try:
        form, classes = read_form(grounded), read_form(anonymized)
    except LanguageError:
        return grounded
    renamed = _rename_constants(form, classes, name, new)
    return to_corpus(renamed) if renamed != form else grounded


def rename_in_template(pattern: str, form: str, name: str, new: str) -> tuple[str, str]:
    """Rename what both sides of a template write out: a text of the form and the same words of the pattern.

    Both stay as they are where only one of them has it, or where the form cannot be read.
    """
    spelling = r"\s+".join(map(re.escape, name.split()))
    words = re.compile(rf"(?<![\w$]){spelling}(?!\w)", re.IGNORECASE)
    slots = [(place.start, place.end) for place in places_in_pattern(pattern)]
    in_pattern = [
        match.span()
        for match in words.finditer(pattern)
        if not any(start < match.end() and match.start() < end for start, end in slots)
    ]
    try:
        texts = [span for span in read_spans(form).walk() if span.kind == "text"]
    except LanguageError:
        return pattern, form
    in_form = [
        (span.start + 1, span.end - 1)
        for span in texts
        if _plain(form[span.start + 1 : span.end - 1]) == _plain(name)
    ]
    if not (in_pattern and in_form):
        return pattern, form
    return replace_parts(pattern, in_pattern, new), replace_parts(form, in_form, new)


def rename_in_conditions(text: str, name: EntityName, new: str) -> str:
    """Return a pattern, an expansion or a form with ``new`` where the condition of a wildcard asks for ``name``."""
    parts: list[tuple[int, int]] = []
    for place in {*places_in_pattern(text), *places_in_form(text)}:
        if isinstance(place.slot, Wildcard) and place.slot.where is not None:
            parts += _values_in(text, place.start, place.end, place.slot, name)
    return replace_parts(text, sorted(set(parts)), new)


def rename_in_attributes(
    attributes: Mapping[str, str], name: EntityName, new: str
) -> dict[str, str]:
    """Return the attributes of another entity, such as its room, with ``new`` for ``name``."""
    return {
        key: new
        if CLASS_OF_ATTRIBUTE.get(key.lower()) == name.entity_class and value == name.text
        else value
        for key, value in attributes.items()
    }


def _values_in(
    text: str, start: int, end: int, wildcard: Wildcard, name: EntityName
) -> list[tuple[int, int]]:
    """Return the parts of the wildcard written from ``start`` to ``end`` that are values equal to ``name``."""
    classes = {**CLASS_OF_ATTRIBUTE, "name": wildcard.entity_class}
    note = re.search(r"\bmeta\s*:", text[start:end], re.IGNORECASE)
    end = start + note.start() if note else end
    return [
        match.span("value")
        for match in _CONDITION.finditer(text, start, end)
        if classes.get(match["property"].lower()) == name.entity_class
        and name.is_written(match["value"])
    ]


def _rename_constants(form: Form, classes: Form, name: EntityName, new: str) -> Form:
    if isinstance(form, Constant) and isinstance(classes, Constant):
        is_it = classes.token_class == name.entity_class and name.is_written(str(form.value))
        return Constant(new) if is_it else form
    if len(children(form)) != len(children(classes)) or type(form) is not type(classes):
        return form
    parts = tuple(
        _rename_constants(each, other, name, new)
        for each, other in zip(children(form), children(classes), strict=True)
    )
    if isinstance(form, Lambda):
        return replace(form, bodies=parts)
    return replace(form, arguments=parts) if isinstance(form, Application) else form


def _plain(words: str) -> str:
    return " ".join(words.casefold().split())
