"""The units of systemd of the operations guide: each can be read, and starts its part again."""

from __future__ import annotations

import re
import shutil
import subprocess

import pytest

from tests.annotations.commands.run_command import ROOT

PAGE = (ROOT / "docs" / "guides" / "operations.md").read_text(encoding="utf-8")
UNITS = re.findall(r"```ini\n# /etc/systemd/system/(\S+): [^\n]*\n(.*?)```", PAGE, re.DOTALL)


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
