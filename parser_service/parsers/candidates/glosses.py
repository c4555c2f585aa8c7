"""Forms in English, by what a protocol allows to be known of their predicates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from annotations.language.errors import LanguageError
from annotations.language.gloss_patterns import pattern_of_name
from annotations.language.logic import Form, read_form
from annotations.language.predicates import (
    Predicate,
    PredicateKind,
    gloss,
    infer_signatures,
)


def glosses(forms: Sequence[str], predicates: Mapping[str, Predicate] | None) -> list[str]:
    """One short English sentence for each form; a text that is no form is its own.

    With declared ``predicates`` their glosses are used (*domain*). Without (*strict*), a predicate
    is called by its name in words, whatever this program knows of names like it.
    """
    read = [_read(form) for form in forms]
    known = _named(read) if predicates is None else predicates
    return [
        text if form is None else gloss(form, known) for text, form in zip(forms, read, strict=True)
    ]


def _named(forms: Sequence[Form | None]) -> dict[str, Predicate]:
    found = infer_signatures(form for form in forms if form is not None)
    return {
        name: replace(
            each,
            gloss=pattern_of_name(name, each.kind == PredicateKind.ACTION, each.signatures),
        )
        for name, each in found.items()
    }


def _read(text: str) -> Form | None:
    try:
        return read_form(text)
    except LanguageError:
        return None
