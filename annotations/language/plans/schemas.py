"""The published schemas of plans: JSON Schema of the data, XML Schema of the behaviour tree."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

_FOLDER = Path(__file__).parent


@cache
def plan_schema_text() -> str:
    """Return the JSON Schema (2020-12) that ``Plan.as_json`` follows, as text."""
    return (_FOLDER / "plan.schema.json").read_text(encoding="utf-8")


def plan_schema() -> dict[str, Any]:
    """Return the JSON Schema that ``Plan.as_json`` follows."""
    schema: dict[str, Any] = json.loads(plan_schema_text())
    return schema


@cache
def behavior_tree_schema_text() -> str:
    """Return the XML Schema of what ``to_behavior_tree`` writes, as text."""
    return (_FOLDER / "behavior_tree.xsd").read_text(encoding="utf-8")
