"""The commands that the docs show as an example run as they are, on the files of the starter world."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

from django.core.management import call_command

from annotations.exchange.starter_world import STARTER_FOLDER
from annotations.models import Entity

REFERENCE = Path(__file__).resolve().parents[3] / "docs" / "reference"


def commands_of(page: str) -> list[list[str]]:
    """Return the commands of the first block of a page, each as its arguments."""
    text = (REFERENCE / page).read_text(encoding="utf-8")
    [block] = re.findall(r"\A# .*?^```sh\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    return [shlex.split(line.partition(" manage.py ")[2]) for line in block.splitlines()]


def test_the_way_from_the_files_of_a_generator_to_a_form(transactional_db, capsys):
    commands = commands_of("commands.md")
    assert commands[0][0] == "import_generator"
    commands[0][1] = str(STARTER_FOLDER)
    for command in commands:
        call_command(*command)
    assert 'bring(λx. is_a(x, "tumbler"))' in capsys.readouterr().out


def test_an_archive_makes_the_same_world(transactional_db, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    call_command("import_generator", str(STARTER_FOLDER), "--world", "household")
    commands = commands_of("archive.md")
    for command in commands:
        call_command(*command)
    old, new = (
        Entity.objects.filter(ontology__world__name=name).values_list("entity_class", "text")
        for name in ("household", commands[-1][-1])
    )
    assert sorted(new) == sorted(old) != []
