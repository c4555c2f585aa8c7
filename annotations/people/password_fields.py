"""How pages ask for a new password: the same words everywhere."""

from __future__ import annotations

from django import forms
from django.core.validators import MaxLengthValidator

MOST_CHARACTERS = 1000  # more would be dear to hash
RULE = "At least 8 characters, and not a common one."


def ask_twice(form: forms.BaseForm, first: str, again: str) -> None:
    """Label the two fields of ``form`` that take a new password, and bound their length."""
    form.fields[first].help_text = RULE
    form.fields[again].help_text = ""
    form.fields[again].label = f"{form.fields[first].label} again"
    for name in (first, again):
        field = form.fields[name]
        assert isinstance(field, forms.CharField)
        field.max_length = MOST_CHARACTERS
        field.validators.append(MaxLengthValidator(MOST_CHARACTERS))
