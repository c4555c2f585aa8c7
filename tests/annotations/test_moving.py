"""An installation moves to another database with all its rows (docs/moving.md)."""

from __future__ import annotations

import re
from pathlib import Path

from django.apps import apps
from django.core.management import call_command
from django.db import connection

from annotations.models import ApiToken, User, World
from annotations.models.worlds import Role
from tests.conftest import member
from tests.sample_world import fill_world

DOCUMENT = (Path(__file__).parents[2] / "docs" / "moving.md").read_text(encoding="utf-8")
EXCLUDED = re.findall(r"--exclude (\S+)", DOCUMENT)
OURS = ("annotations", "parser_service")


def counts() -> dict[str, int]:
    return {
        model._meta.label: model._default_manager.count()
        for name in OURS
        for model in apps.get_app_config(name).get_models()
    }


def test_what_is_dumped_is_loaded_row_for_row(transactional_db, tmp_path):
    world = World.objects.create(name="home")
    sample = fill_world(world)
    anna = member(world, "anna", Role.ANNOTATOR)
    token, key = ApiToken.issue(anna, "notebook")
    before, template = counts(), sample.template
    file = str(tmp_path / "everything.json.gz")
    call_command("dumpdata", exclude=EXCLUDED, output=file, verbosity=0)

    call_command("flush", interactive=False, verbosity=0)
    assert sum(counts().values()) == 0
    call_command("loaddata", file, verbosity=0)

    assert counts() == before and before["annotations.Command"] == 3
    template.refresh_from_db()
    assert template.pattern == sample.template.pattern
    assert ApiToken.objects.for_key(key) == token
    assert User.objects.get(username="anna").check_password("correct horse")


def test_new_rows_follow_those_that_were_loaded(transactional_db, tmp_path):
    old = World.objects.create(pk=41, name="home")
    file = str(tmp_path / "everything.json.gz")
    call_command("dumpdata", "annotations.world", output=file, verbosity=0)
    connection.close()
    old.delete()
    call_command("loaddata", file, verbosity=0)
    assert World.objects.create(name="laboratory").pk > 41
