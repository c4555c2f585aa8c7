"""The README and the code say the same."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
SETTINGS = "".join(
    path.read_text(encoding="utf-8") for path in (ROOT / "gpsr_site" / "settings").glob("*.py")
)
TABLE_ROW = re.compile(r"^\| `([A-Z_]+)` \|", re.MULTILINE)
# Django's and Celery's own; read by the shell, the tests or a library rather than by the settings.
READ_ELSEWHERE = {
    "GPSR_ENGLISH_DIR",
    "GPSR_SHARED_DATA",
    "TEST_DATABASE_URL",
    "TEST_BROKER_URL",
    "TEST_KILLS",
    "TEST_WALK",
    "TEST_SCHEMA_CASES",
}


def variables_of_the_settings() -> set[str]:
    return set(re.findall(r'env(?:\.\w+)?\(\s*"([A-Z_]+)"', SETTINGS)) | set(
        re.findall(r'_required_when_served\("([A-Z_]+)"', SETTINGS)
    )


def test_every_variable_of_the_settings_is_documented_and_no_other():
    assert set(TABLE_ROW.findall(README)) - READ_ELSEWHERE == variables_of_the_settings()


def test_variables_of_the_tests_are_documented():
    assert set(TABLE_ROW.findall(README)) >= READ_ELSEWHERE


@pytest.mark.parametrize("target", ["run", "test"])
def test_the_commands_of_the_readme_exist_in_the_makefile(target):
    assert f"make {target}" in README
    assert re.search(rf"^{target}:", (ROOT / "Makefile").read_text(), re.MULTILINE)


def test_every_management_command_is_named_in_the_readme():
    folders = ROOT.glob("*/management/commands")
    commands = {path.stem for folder in folders for path in folder.glob("[a-z]*.py")}
    missing = {name for name in commands if f"`{name}" not in README}
    assert not missing


def test_links_of_the_readme_lead_to_files():
    for target in re.findall(r"\]\((?!http)([^)#]+)", README):
        assert (ROOT / target).exists(), target
