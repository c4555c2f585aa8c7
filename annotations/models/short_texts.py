"""A column for a text that the program makes for people to read, such as a title."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from django.db import models

if TYPE_CHECKING:
    PlainCharField = models.CharField[Any, Any]
else:  # Django's fields take no type arguments at run time
    PlainCharField = models.CharField


class ShortTextField(PlainCharField):
    """Stores as much of a text as the column holds, however it is written: in bulk and by ``update`` too.

    What people type is refused where it is too long, and has a plain ``CharField``. Keys and names by which rows are
    found have one too.
    """

    def get_prep_value(self, value: Any) -> Any:
        text = super().get_prep_value(value)
        return text[: self.max_length] if isinstance(text, str) else text

    def deconstruct(self) -> Any:
        """Describe the plain field: the database knows no other."""
        name, _, args, kwargs = super().deconstruct()
        return name, "django.db.models.CharField", args, kwargs
