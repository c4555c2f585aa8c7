"""What a person did wrong is a refusal in every verb: pages, routes and commands can say it alike."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
# What only the caller in the code, or a file that somebody changed, can cause.
OTHERS = {
    "annotations/labelling/form_check.py",  # asked about what is a label
    "annotations/world_archive/row_texts.py",  # caught by the reader of archives
}


@pytest.mark.parametrize(
    "path",
    [
        path
        for path in sorted((ROOT / "annotations").rglob("*.py"))
        if not {"language", "migrations"} & set(path.relative_to(ROOT).parts)
    ],
    ids=lambda path: str(path.relative_to(ROOT)),
)
def test_no_verb_raises_a_bare_value_error(path):
    raised = [
        node.lineno
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Raise)
        and isinstance(node.exc, ast.Call)
        and getattr(node.exc.func, "id", "") == "ValueError"
    ]
    assert not raised or str(path.relative_to(ROOT)) in OTHERS
