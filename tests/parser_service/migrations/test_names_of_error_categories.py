"""Error categories of one name are numbered."""

from __future__ import annotations

from importlib import import_module

from django.apps import apps
from django.db import connection

from parser_service.models import ErrorCategory

migration = import_module("parser_service.migrations.0017_names_of_error_categories")


def test_repeated_names_are_numbered(world, other_world):
    with connection.cursor() as cursor:
        cursor.execute("DROP INDEX error_category_name")
    long = "x" * 60
    names = ["slip", "Slip", "slip", "slip (2)", long, long]
    for position, name in enumerate(names):
        ErrorCategory.objects.create(
            world=world, code=f"code_{position}", name=name, position=position
        )
    ErrorCategory.objects.create(world=other_world, code="slip", name="slip", position=0)
    migration.number_repeated_names(apps, None)
    named = list(world.error_categories.values_list("name", flat=True))
    assert named == ["slip", "Slip (2)", "slip (3)", "slip (2) (2)", long, f"{long[:56]} (2)"]
    assert other_world.error_categories.get().name == "slip"
