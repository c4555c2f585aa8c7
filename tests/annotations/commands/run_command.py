"""Runs a management command as a script would."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
from pathlib import Path

from django.core.management import CommandError, call_command

ROOT = Path(__file__).resolve().parents[3]


def run(*arguments):
    """In this process, with ``--json``: the object printed (or None), and the error, if any."""
    out, failure = io.StringIO(), None
    try:
        call_command(*map(str, arguments), "--json", stdout=out)
    except CommandError as error:
        failure = error
    return json.loads(out.getvalue() or "null"), failure


def run_process(var_dir, *arguments):
    """In a process of its own, with its database under ``var_dir``."""
    environment = {**os.environ, "GPSR_VAR_DIR": str(var_dir)}
    environment.pop("DATABASE_URL", None)
    return subprocess.run(
        [sys.executable, "manage.py", *map(str, arguments)],
        cwd=ROOT,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
