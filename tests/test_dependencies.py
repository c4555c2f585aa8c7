"""Whatever the product imports is installed with it, and not only with what the tests need."""

from __future__ import annotations

import ast
import re
import sys
import tomllib
from importlib.metadata import packages_distributions
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ROOMS = ("annotations", "parser_service", "gpsr_site")
OPTIONAL = {"django-allauth", "h5py", "mlflow-skinny", "pyarrow"}  # of the extras


def normal(name: str) -> str:
    """Return the name of a distribution as indexes compare it."""
    return re.sub(r"[-_.]+", "-", name).lower()


def imported_by(path: Path) -> set[str]:
    """Return the top-level modules that a file imports anywhere in it."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name.partition(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            names.add(node.module.partition(".")[0])
    return names


def test_what_is_imported_is_declared():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    requirements = (re.match(r"[\w.-]+", each)[0] for each in project["dependencies"])
    declared = set(map(normal, requirements)) | OPTIONAL
    distributions = packages_distributions()
    undeclared = {
        f"{path.relative_to(ROOT)}: {name}"
        for room in ROOMS
        for path in (ROOT / room).rglob("*.py")
        for name in imported_by(path) - sys.stdlib_module_names - set(ROOMS)
        if not declared & set(map(normal, distributions.get(name, ())))
    }
    assert undeclared == set()
