"""Imports go one way: gpsr_site → parser_service → annotations → annotations.language."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
OURS = ("gpsr_site", "parser_service", "annotations")

# What the modules below a package may not import.
FORBIDDEN = {
    "annotations/language": ("django", "rest_framework", "torch", "transformers", "pandas"),
    "annotations": ("parser_service", "gpsr_site", "torch", "transformers"),
    "parser_service": ("gpsr_site",),
    "parser_service/neural": ("django", "rest_framework"),
    "parser_service/parsers": ("django", "rest_framework", "torch", "transformers"),
    "parser_service/analysis": ("django", "rest_framework", "torch", "transformers"),
}
# Of our own code, these import nothing but the language core and themselves.
LANGUAGE_ONLY = ("parser_service/parsers", "parser_service/neural", "parser_service/analysis")
THEIR_OWN = (
    "annotations.language",
    "parser_service.parsers",
    "parser_service.neural",
    "parser_service.analysis",
)


def imports_of(path: Path) -> set[str]:
    """The dotted names that a module imports, anywhere in it."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            found.add(node.module)
    return found


def modules_below(folder: str) -> list[Path]:
    return sorted((ROOT / folder).rglob("*.py"))


@pytest.mark.parametrize("folder", FORBIDDEN)
def test_no_module_imports_what_its_layer_may_not(folder):
    for path in modules_below(folder):
        for name in imports_of(path):
            assert name.split(".")[0] not in FORBIDDEN[folder], f"{path} imports {name}"


def test_the_language_core_imports_nothing_else_of_ours():
    for path in modules_below("annotations/language"):
        for name in imports_of(path):
            if name.split(".")[0] in OURS:
                assert name.startswith("annotations.language"), f"{path} imports {name}"


@pytest.mark.parametrize("folder", LANGUAGE_ONLY)
def test_parsers_networks_and_analysis_know_only_the_language_core(folder):
    for path in modules_below(folder):
        for name in imports_of(path):
            if name.split(".")[0] in OURS:
                assert name.startswith(THEIR_OWN), f"{path} imports {name}"


def test_every_relation_between_modules_is_spelled_absolutely():
    for folder in OURS:
        for path in modules_below(folder):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.ImportFrom):
                    assert not node.level, f"{path} has a relative import"


def test_the_web_process_never_imports_torch():
    script = (
        "import sys, gpsr_site.wsgi; from django.urls import get_resolver; "
        "get_resolver().url_patterns; sys.exit('torch' in sys.modules)"
    )
    subprocess.run([sys.executable, "-c", script], cwd=ROOT, check=True)
