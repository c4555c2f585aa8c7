"""The Containerfile names what is there: files, commands and variables."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from django.core.management import get_commands

ROOT = Path(__file__).resolve().parents[2]
LINES = (ROOT / "Containerfile").read_text(encoding="utf-8").splitlines()
STEPS = [line.split(maxsplit=1) for line in LINES if line and not line.startswith("#")]
KNOWN = {"FROM", "WORKDIR", "COPY", "RUN", "ENV", "USER", "VOLUME", "EXPOSE", "ENTRYPOINT", "CMD"}
OF_OTHERS = {"PYTHONUNBUFFERED", "PIP_NO_CACHE_DIR"}


def arguments(name: str) -> list[str]:
    return [rest for step, rest in STEPS if step == name]


def test_every_line_is_an_instruction():
    assert {step for step, _ in STEPS} <= KNOWN
    assert STEPS[0][0] == "FROM"


@pytest.mark.parametrize("copied", [each for each in arguments("COPY") if "--from" not in each])
def test_what_is_copied_is_there(copied):
    for source in copied.split()[:-1]:
        assert (ROOT / source).exists()


def test_it_calls_a_command_as_somebody_who_is_not_root():
    (entry,), (command,) = arguments("ENTRYPOINT"), arguments("CMD")
    assert json.loads(entry) == ["python", "manage.py"]
    assert json.loads(command)[0] in get_commands()
    assert arguments("USER") == ["gpsr"]


def test_its_variables_are_documented():
    names = {name for each in arguments("ENV") for name in re.findall(r"([A-Z_]+)=", each)}
    documented = (ROOT / "docs" / "reference" / "variables.md").read_text(encoding="utf-8")
    assert all(f"| `{name}` |" in documented for name in names - OF_OTHERS)


def test_packages_of_python_are_all_copied():
    packages = {path.parent.name for path in ROOT.glob("*/apps.py")}
    assert {f"{name} ./{name}" for name in packages} <= set(arguments("COPY"))
