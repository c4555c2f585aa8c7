"""Columns whose value follows from other columns of their row, stored so that the database can filter by them."""

from __future__ import annotations

from typing import Any

from django.db import models


class DerivedField(models.Field):
    """Takes its value from the row's method ``derive_NAME`` whenever the row is written.

    Bulk creation and ``annotations.rows.staging`` write it too; an archive of a world leaves it out.
    """

    is_derived = True

    def pre_save(self, model_instance: models.Model, add: bool) -> Any:
        value = getattr(model_instance, f"derive_{self.attname}")()
        setattr(model_instance, self.attname, value)
        return value

    def deconstruct(self) -> Any:
        """Describe the plain field, since the rows of migrations have no methods."""
        name, _, args, kwargs = super().deconstruct()
        plain = next(each for each in type(self).__mro__ if each.__module__ != __name__)
        return name, f"django.db.models.{plain.__name__}", args, kwargs


class DerivedIntegerField(DerivedField, models.PositiveIntegerField):
    """A derived whole number."""


class DerivedCharField(DerivedField, models.CharField):
    """A derived text."""
