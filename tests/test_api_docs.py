"""The examples of docs/reference/rest.md run as they are, and its table names every route."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from annotations.importing.generator_import import import_generator
from annotations.models import ApiToken, Entity
from parser_service.models import TrainingRun
from tests.annotations.conftest import TINY, as_bytes
from tests.gpsr_site.routes.listing import ALL_ROUTES

TEXT = (Path(__file__).resolve().parent.parent / "docs" / "reference" / "rest.md").read_text(
    encoding="utf-8"
)
SECONDS = 120


def examples(language: str) -> str:
    return "\n".join(re.findall(rf"^```{language}\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL))


@pytest.fixture
def run(transactional_db, live_server, world, admin, superuser, tmp_path):
    """A function that runs a program with BASE and tokens of a tiny world; it has to succeed."""
    if not (shutil.which("curl") and shutil.which("jq")):
        pytest.skip("needs curl and jq")
    assert not import_generator(world.name, as_bytes(TINY)).is_refused
    _, key = ApiToken.issue(admin, "notebook")
    _, site_key = ApiToken.issue(superuser, "site")
    base = f"{live_server.url}/api/v1/worlds/{world.name}"
    environment = {**os.environ, "BASE": base, "TOKEN": key, "SITE_TOKEN": site_key}

    def go(*command: str) -> None:
        done = subprocess.run(
            command, env=environment, cwd=tmp_path, capture_output=True, text=True, timeout=SECONDS
        )
        assert done.returncode == 0, f"{done.stdout[-2000:]}\n{done.stderr[-2000:]}"

    return go


@pytest.mark.processes
def test_the_examples_run_one_after_another(run, tmp_path):
    run("bash", "-euo", "pipefail", "-c", examples("bash"))
    assert Entity.objects.get(text="oat milk").aliases == ["oat drink"]
    assert TrainingRun.objects.get().status == "cancelled"
    assert (tmp_path / "split.zip").read_bytes().startswith(b"PK")
    run(sys.executable, "-c", examples("python"))
    assert TrainingRun.objects.count() == 3


def test_the_table_names_every_route():
    table = TEXT[TEXT.index("## Routes") :]
    paths = [path for name, path in ALL_ROUTES.items() if name.startswith("api:")]
    for path in paths:
        below = path.removeprefix("api/v1/worlds/<slug:world>/").removeprefix("api/v1/")
        nouns = re.sub(r"<[^>]+>", "", below).strip("/").split("/")
        for noun in filter(None, nouns):
            assert f"{noun}/" in table, path
