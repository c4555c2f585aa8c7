"""What the commands of this project say of themselves."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from django.core.management import get_commands, load_command_class

OURS = sorted(
    name
    for name, app in get_commands().items()
    if app in ("annotations", "parser_service", "gpsr_site")
)


@pytest.mark.parametrize("name", OURS)
def test_each_says_what_it_does_and_what_it_takes(name):
    parser = load_command_class(get_commands()[name], name).create_parser("manage.py", name)
    assert parser.description
    assert name in parser.format_help()


@pytest.mark.processes
def test_a_database_that_is_away_is_a_sentence_for_every_command(tmp_path):
    away = {**os.environ, "DATABASE_URL": "postgres://gpsr@127.0.0.1:1/gpsr"}
    for name in ("migrate", "createsuperuser", "backup"):
        words = {
            "backup": [str(tmp_path / "all.zip")],
            "createsuperuser": ["--noinput", "--username", "x"],
        }
        done = subprocess.run(
            [sys.executable, "manage.py", name, *words.get(name, [])],
            cwd=Path(__file__).parents[2],
            env=away,
            capture_output=True,
            text=True,
        )
        assert done.returncode == 1, name
        assert "Traceback" not in done.stderr and "127.0.0.1" in done.stderr, name
