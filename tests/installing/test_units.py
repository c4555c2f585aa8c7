"""The units of systemd and the compose file of the operations guide: each can be read, and starts its part again."""

from __future__ import annotations

import re
import shutil
import subprocess

import pytest
import yaml
from django.core.management import get_commands

from tests.annotations.commands.run_command import ROOT

PAGE = (ROOT / "docs" / "guides" / "operations.md").read_text(encoding="utf-8")
UNITS = re.findall(r"```ini\n# /etc/systemd/system/(\S+): [^\n]*\n(.*?)```", PAGE, re.DOTALL)
(COMPOSE,) = re.findall(r"```yaml\n# compose.yaml\n(.*?)```", PAGE, re.DOTALL)
OURS = {
    name: part
    for name, part in yaml.safe_load(COMPOSE)["services"].items()
    if part["image"] == "gpsr-workbench"
}


@pytest.mark.parametrize(("name", "text"), UNITS, ids=[name for name, _ in UNITS])
def test_a_unit_is_what_systemd_understands(name, text, tmp_path):
    assert "Restart=always" in text
    if not shutil.which("systemd-analyze"):
        pytest.skip("needs systemd-analyze")
    here = text.replace("/srv/gpsr-workbench/.venv/bin/python", shutil.which("true") or "")
    (tmp_path / name).write_text(here)
    checked = subprocess.run(
        ["systemd-analyze", "verify", "--man=no", "--recursive-errors=no", tmp_path / name],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (checked.returncode, name in checked.stderr) == (0, False), checked.stderr


@pytest.mark.parametrize("name", OURS)
def test_a_service_is_a_command_that_is_started_again(name):
    command = OURS[name]["command"][0]
    assert command in get_commands()
    lasts = command not in ("migrate", "collectstatic")
    assert OURS[name]["restart"] == ("unless-stopped" if lasts else "no")


def test_a_worker_runs_for_each_queue():
    served = {
        queue
        for part in OURS.values()
        for queue in part["command"][2:]
        if "work" in part["command"]
    }
    assert served == {"quick", "cpu", "gpu"}
