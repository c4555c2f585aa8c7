"""What forms and serializers say of a value that is none of their choices, in plain words."""

from __future__ import annotations

from django import forms
from rest_framework import serializers

NO_CHOICE = "This is not one of the choices, or not any more. Choose one of the list."
FORM_FIELDS = (forms.ChoiceField, forms.MultipleChoiceField)
ROW_FIELDS = (forms.ModelChoiceField, forms.ModelMultipleChoiceField)


def speak_plainly() -> None:
    """Replace the messages of Django and the REST framework, for all forms and routes."""
    for field in FORM_FIELDS:
        field.default_error_messages["invalid_choice"] = (
            "“%(value)s” is not one of the choices. Choose one of the list."
        )
    for of_rows in ROW_FIELDS:
        of_rows.default_error_messages["invalid_choice"] = NO_CHOICE
    serializers.ChoiceField.default_error_messages["invalid_choice"] = (
        "“{input}” is not one of the choices. /api/v1/schema/ lists them."
    )
