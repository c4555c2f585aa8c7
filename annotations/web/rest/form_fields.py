"""Bodies of requests that are made from the forms of the pages: a bound, a choice or a word stands in one place."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from django import forms
from rest_framework import serializers

from annotations.web.rest.fields import Fields, LineField

FieldOfBody = serializers.Field[Any, Any, Any, Any]


class FormFields(Fields):
    """A body with fields of a form: bounds, choices and words are those of the form.

    ``Meta.form`` and ``Meta.fields`` name them; with ``Meta.begins`` they are at their default where they are left out.
    A class below another one adds to its fields. A field that is declared takes the place of the form's, where JSON
    has it otherwise, such as a list for lines of text.
    """

    class Meta:
        form: type[forms.Form]
        fields: Sequence[str] = ()

    def get_fields(self) -> dict[str, Any]:
        declared = super().get_fields()
        metas = [vars(cls)["Meta"] for cls in type(self).__mro__ if "Meta" in vars(cls)]
        read = {
            name: sent_field(meta.form.base_fields[name], begins=getattr(meta, "begins", False))
            for meta in metas
            for name in meta.fields
            if name not in declared
        }
        return {**read, **declared}


def sent_field(field: forms.Field, *, begins: bool = False) -> FieldOfBody:
    """Return how JSON has what the field of a form takes; where it ``begins``, with the default of the page."""
    options: dict[str, Any] = {"help_text": str(field.help_text)} if field.help_text else {}
    is_open = not field.required
    if begins and (field.initial is not None or is_open):
        options["default"] = field.to_python(field.initial)
    elif is_open:
        options["required"] = False
    if isinstance(field, forms.MultipleChoiceField):
        child = serializers.ChoiceField(choices=list(getattr(field, "choices", ())))
        return serializers.ListField(child=child, allow_empty=is_open, **options)
    if choices := [*getattr(field, "choices", ())]:
        return serializers.ChoiceField(choices=choices, **options)
    if isinstance(field, forms.BooleanField):
        return serializers.BooleanField(**options)
    if is_open and isinstance(field, forms.IntegerField | forms.DateField):
        options["allow_null"] = True
    if isinstance(field, forms.DateField):
        return serializers.DateField(**options)
    if isinstance(field, forms.IntegerField):
        return _number(field, options)
    return _text(field, options)


def _number(field: forms.IntegerField, options: dict[str, Any]) -> FieldOfBody:
    options |= {"min_value": field.min_value, "max_value": field.max_value}
    if isinstance(field, forms.DecimalField):
        return serializers.DecimalField(field.max_digits, field.decimal_places, **options)
    if isinstance(field, forms.FloatField):
        return serializers.FloatField(**options)
    return serializers.IntegerField(**options)


def _text(field: forms.Field, options: dict[str, Any]) -> FieldOfBody:
    options["max_length"] = getattr(field, "max_length", None)
    if not field.required:
        options["allow_blank"] = True
    if isinstance(field, forms.RegexField):
        pattern = field.regex.pattern.removeprefix(r"\A").removesuffix(r"\Z")
        return serializers.RegexField(f"^({pattern}){'' if field.required else '?'}$", **options)
    if isinstance(field, forms.SlugField):
        return serializers.SlugField(**options)
    if isinstance(field, forms.URLField):
        return serializers.URLField(**options)
    if not isinstance(field.widget, forms.Textarea):
        return LineField(**options)
    return serializers.CharField(trim_whitespace=getattr(field, "strip", True), **options)
