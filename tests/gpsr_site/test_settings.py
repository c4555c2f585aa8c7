"""Settings that cannot be used stop the start with one sentence."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize(
    ("variable", "value", "sentence"),
    [
        (
            "HOST",
            "0.0.0.0",
            "SECRET_KEY is not set, and HOST=0.0.0.0 serves more than this machine.",
        ),
        ("LOG_FORMAT", "xml", "LOG_FORMAT is xml; it is line or json."),
    ],
)
def test_the_start_stops_with_a_sentence(tmp_path, variable, value, sentence):
    environment = {**os.environ, "GPSR_VAR_DIR": str(tmp_path), variable: value}
    for name in ("SECRET_KEY", "ALLOWED_HOSTS", "DEBUG"):
        environment.pop(name, None)
    done = subprocess.run(
        [sys.executable, "manage.py", "check"],
        cwd=ROOT,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    assert done.stderr.startswith(sentence) and "Traceback" not in done.stderr
