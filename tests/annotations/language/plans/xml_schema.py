"""The XML schema of behaviour trees, read once."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from annotations.language.plans import behavior_tree_schema_text

if TYPE_CHECKING:
    from xmlschema import XMLSchema


@cache
def xml_schema() -> XMLSchema:
    from xmlschema import XMLSchema  # slow to import

    return XMLSchema(behavior_tree_schema_text())
