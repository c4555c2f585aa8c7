"""Settings that cannot be used stop the start with one sentence."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize(
    ("variable", "value", "named"),
    [
        ("HOST", "0.0.0.0", ["SECRET_KEY", "HOST=0.0.0.0"]),
        ("LOG_FORMAT", "xml", ["LOG_FORMAT", "xml", "line", "json"]),
    ],
)
def test_the_start_stops_with_a_sentence(tmp_path, variable, value, named):
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
    assert all(each in done.stderr for each in named) and "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("database", "asked", "processes"),
    [
        ("", "", 1),
        ("postgres://nobody@127.0.0.1:1/none", "", min(len(os.sched_getaffinity(0)), 4)),
        ("postgres://nobody@127.0.0.1:1/none", "7", 7),
        ("", "2", 2),
    ],
)
def test_as_many_web_processes_as_the_database_has_use_for(tmp_path, database, asked, processes):
    environment = {
        **os.environ,
        "GPSR_VAR_DIR": str(tmp_path),
        "DJANGO_SETTINGS_MODULE": "gpsr_site.settings",
    }
    for name, value in (("DATABASE_URL", database), ("WEB_PROCESSES", asked)):
        environment.pop(name, None)
        environment |= {name: value} if value else {}
    assert say_processes(environment) == processes


def test_a_system_that_tells_no_processors_of_a_process_can_start(tmp_path):
    environment = {
        **os.environ,
        "GPSR_VAR_DIR": str(tmp_path),
        "DJANGO_SETTINGS_MODULE": "gpsr_site.settings",
        "DATABASE_URL": "postgres://nobody@127.0.0.1:1/none",
    }
    environment.pop("WEB_PROCESSES", None)
    as_on_macos = "import os; del os.sched_getaffinity; "
    assert say_processes(environment, as_on_macos) == min(os.cpu_count() or 1, 4)


def say_processes(environment: dict[str, str], before: str = "") -> int:
    said = subprocess.run(
        [
            *(sys.executable, "-c"),
            f"{before}from django.conf import settings; print(settings.WEB_PROCESSES)",
        ],
        cwd=ROOT,
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    return int(said.stdout)
