"""What all forms share: the data that was sent, and the sentence for a refused text."""

from __future__ import annotations

from typing import Any

from django import forms
from django.http import QueryDict

from annotations.language.texts import LanguageError
from annotations.people.access import PageRequest


def posted(request: PageRequest) -> QueryDict | None:
    """Return the data to bind a form to; None when nothing has been sent."""
    return request.POST if request.method == "POST" else None


def sentence_of(error: LanguageError) -> str:
    """Return what is wrong and what to do about it, without the place."""
    message = error.message[:1].upper() + error.message[1:]
    hint = f" {error.hint[:1].upper()}{error.hint[1:]}." if error.hint else ""
    return f"{message}.{hint}"


def row_field(form: forms.BaseForm, name: str) -> forms.ModelChoiceField[Any]:
    """Return the field of ``form`` in which a row is chosen, typed so that its choices can be set."""
    field = form.fields[name]
    assert isinstance(field, forms.ModelChoiceField)
    return field


def choice_field(form: forms.BaseForm, name: str) -> forms.ChoiceField:
    """Return the field of ``form`` in which a text is chosen, typed so that its choices can be set."""
    field = form.fields[name]
    assert isinstance(field, forms.ChoiceField)
    return field
