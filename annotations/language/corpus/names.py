"""Check names, and rename nonterminals, predicates and entities in texts. The rest of a text stays as it is."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from annotations.language.forms import (
    Application,
    Constant,
    Form,
    Lambda,
    Nonterminal,
    SlotPlace,
    SymbolReader,
    Wildcard,
    children,
    places_in_form,
    places_in_pattern,
    read_form,
    read_spans,
    split_head,
    to_corpus,
)
from annotations.language.grounding import Anonymizer
from annotations.language.texts import (
    MAX_ENTITY,
    MAX_NONTERMINAL,
    MAX_PREDICATE,
    LanguageError,
    Position,
    require_name,
    require_writable,
)

_NONTERMINAL = re.compile(r"[^\W\d]\w*")
_PREDICATE = re.compile(r"[^\W\d][\w-]*")
# They mark class tokens, wildcards, texts and lists of names.
_RESERVED = re.compile(r'[<>{}"|\n\r\t]')
# The attributes that name another entity → its class.
CLASS_OF_ATTRIBUTE = {"category": "category", "room": "room", "defaultlocation": "location"}
_CONDITION = re.compile(r'(?<!\w)(?P<property>\w++)\s*+(?:!=|=)\s*+"(?P<value>[^"{}]*)"')


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


def rename_nonterminal_in_pattern(text: str, old: str, new: str) -> str:
    """Return a pattern or an expansion with ``$new`` for ``$old``, also in the notes of wildcards.

    A text that cannot be read, such as a draft, is changed outside of notes.
    """
    reader = SymbolReader(text, Position())
    try:
        reader.whole_line()
    except LanguageError:
        name, start = split_head(text)
        head = text[:start].replace(f"${old}", f"${new}") if name == old else text[:start]
        return head + _rename_places(text[start:], places_in_pattern(text[start:]), old, new)
    starts = sorted(place.column - 1 for name, place in reader.references if name == old)
    return replace_parts(text, ((start, start + 1 + len(old)) for start in starts), f"${new}")


def rename_nonterminal_in_form(text: str, old: str, new: str) -> str:
    """Return a form with ``$new`` for ``$old``, as an argument or as a predicate."""
    return _rename_places(text, places_in_form(text), old, new)


def _rename_places(text: str, places: Iterable[SlotPlace], old: str, new: str) -> str:
    wanted = Nonterminal(old)
    parts = ((place.start, place.end) for place in places if place.slot == wanted)
    return replace_parts(text, parts, f"${new}")


def rename_predicate(text: str, old: str, new: str) -> str:
    """Return a form, in any notation, with ``new`` where ``old`` is a predicate.

    A canonical form stays canonical. A text that is not a form stays as it is.
    """
    if old not in text:
        return text
    try:
        spans = list(read_spans(text).walk())
    except LanguageError:
        return text
    parts = sorted(
        (span.name_start, span.name_end)
        for span in spans
        if span.kind == "application" and span.name == old
    )
    return replace_parts(text, parts, new)


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

    A text is renamed only where ``anonymized``, the same form with class tokens, has a token of the class.
    Forms that cannot be read, or are not the same, stay as they are.
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
            classes = {**CLASS_OF_ATTRIBUTE, "name": place.slot.entity_class}
            note = re.search(r"\bmeta\s*:", text[place.start : place.end], re.IGNORECASE)
            end = place.start + note.start() if note else place.end
            parts += [
                match.span("value")
                for match in _CONDITION.finditer(text, place.start, end)
                if classes.get(match["property"].lower()) == name.entity_class
                and name.is_written(match["value"])
            ]
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


def replace_parts(text: str, parts: Iterable[tuple[int, int]], new: str) -> str:
    """Return ``text`` with ``new`` for each part (start, end); the parts are in order and apart."""
    pieces: list[str] = []
    last = 0
    for start, end in parts:
        pieces += [text[last:start], new]
        last = end
    return "".join((*pieces, text[last:]))
