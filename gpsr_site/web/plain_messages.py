"""What forms and serializers say of a value that is none of their choices, or of another type, in plain words."""

from __future__ import annotations

from typing import Any

from django import forms
from rest_framework import serializers

NO_CHOICE = "This is not one of the choices, or not any more. Choose one of the list."
FORM_FIELDS = (forms.ChoiceField, forms.MultipleChoiceField)
_NO_OBJECT = "Send an object here: names with values."
_NO_LIST = "Send a list here: […]."
# Class → code → what it says.
OF_TYPES: dict[type[serializers.Field[Any, Any, Any, Any]], dict[str, str]] = {
    serializers.ListField: {"not_a_list": _NO_LIST},
    serializers.ListSerializer: {"not_a_list": _NO_LIST},
    serializers.DictField: {"not_a_dict": _NO_OBJECT},
    serializers.Serializer: {"invalid": _NO_OBJECT},
    serializers.CharField: {"invalid": "Send a text here."},
    serializers.IntegerField: {"invalid": "Send a whole number here."},
    serializers.FloatField: {"invalid": "Send a number here."},
    serializers.BooleanField: {"invalid": "Send true or false here."},
}
ROW_FIELDS = (forms.ModelChoiceField, forms.ModelMultipleChoiceField)


def speak_plainly() -> None:
    """Replace the messages of Django and the REST framework, for all forms and routes."""
    for field in FORM_FIELDS:
        field.default_error_messages["invalid_choice"] = (
            "“%(value)s” is not one of the choices. Choose one of the list."
        )
    for of_rows in ROW_FIELDS:
        of_rows.default_error_messages["invalid_choice"] = NO_CHOICE
    for kind, messages in OF_TYPES.items():
        kind.default_error_messages.update(messages)
    serializers.ChoiceField.default_error_messages["invalid_choice"] = (
        "“{input}” is not one of the choices. /api/v1/schema/ lists them."
    )
