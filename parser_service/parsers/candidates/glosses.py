"""Glosses of forms in English, from what a protocol allows a parser to know of their predicates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from annotations.language.errors import LanguageError
from annotations.language.forms import Form, read_form
from annotations.language.predicates import (
    Predicate,
    gloss,
    infer_signatures,
    pattern_of_name,
)
from parser_service.parsers.interface import Check, keep_going


def glosses(
    forms: Sequence[str],
    predicates: Mapping[str, Predicate] | None,
    check: Check = keep_going,
) -> list[str]:
    """Return a short English sentence for each form; a text that is not a form is its own gloss.

    Declared ``predicates`` have glosses (*domain*). Without them (*strict*) a predicate is called by
    the words of its name, even where this program knows better.
    """
    read = [_read(form) for form in forms]
    known = _name_predicates(read) if predicates is None else predicates
    texts = []
    for text, form in zip(forms, read, strict=True):
        check()
        texts.append(text if form is None else gloss(form, known))
    return texts


def _name_predicates(forms: Sequence[Form | None]) -> dict[str, Predicate]:
    inferred = infer_signatures(form for form in forms if form is not None)
    return {
        name: replace(each, gloss=pattern_of_name(name, each.is_action, each.signatures))
        for name, each in inferred.items()
    }


def _read(text: str) -> Form | None:
    try:
        return read_form(text)
    except LanguageError:
        return None
