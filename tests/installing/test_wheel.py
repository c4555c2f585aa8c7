"""What ``make wheel`` builds runs outside a checkout."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import sysconfig
import tomllib
import venv
from pathlib import Path
from typing import NamedTuple

import pytest

ROOT = Path(__file__).parents[2]
SOURCES = [
    *("gpsr_site", "annotations", "parser_service", "templates", "static", "docs"),
    *("setup.py", "pyproject.toml", "MANIFEST.in", "README.md", "LICENSE", "manage.py"),
]
pytestmark = pytest.mark.processes


class Installed(NamedTuple):
    """The command line of an installed wheel, in an empty folder."""

    program: Path
    folder: Path

    def run(self, *words: str) -> subprocess.CompletedProcess[str]:
        names = ("DJANGO_SETTINGS_MODULE", "PYTHONPATH", "GPSR_VAR_DIR", "DATABASE_URL")
        kept = {name: value for name, value in os.environ.items() if name not in names}
        kept |= {"HOME": str(self.folder), "XDG_DATA_HOME": str(self.folder / "data")}
        return subprocess.run(
            [self.program, *words], cwd=self.folder, env=kept, capture_output=True, text=True
        )


def copied_sources(folder: Path) -> Path:
    """Copy what a wheel is built of, so that nothing is built beside the tests that run."""
    for name in SOURCES:
        if (source := ROOT / name).is_dir():
            shutil.copytree(source, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy(source, folder / name)
    return folder


def built(sources: Path, target: Path) -> subprocess.CompletedProcess[str]:
    options = ("--no-deps", "--no-build-isolation", "--no-index", "--wheel-dir", str(target))
    command = [sys.executable, "-m", "pip", "wheel", "--quiet", *options, str(sources)]
    return subprocess.run(command, capture_output=True, text=True)


@pytest.fixture(scope="module")
def installed(tmp_path_factory) -> Installed:
    """Install the wheel into an environment of its own, with the other packages of this one."""
    folder = tmp_path_factory.mktemp("wheel")
    made = built(copied_sources(folder / "sources"), folder)
    assert not made.returncode, made.stderr
    [wheel] = folder.glob("*.whl")
    environment = folder / "environment"
    venv.create(environment, symlinks=True)
    packages = Path(sysconfig.get_path("purelib", vars={"base": str(environment)}))
    into = ["--no-deps", "--no-index", "--quiet", str(wheel)]
    python = environment / "bin" / "python"
    done = subprocess.run(
        [sys.executable, "-m", "pip", "--python", str(python), "install", *into],
        capture_output=True,
        text=True,
    )
    assert not done.returncode, done.stderr
    # Read as a folder, not as site-packages: an editable installation in it would be taken, too.
    (packages / "others.pth").write_text(sysconfig.get_path("purelib"))
    (home := folder / "home").mkdir()
    return Installed(environment / "bin" / "gpsr-workbench", home)


def test_it_says_its_version(installed):
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert installed.run("--version").stdout.strip() == project["version"]
    assert installed.run("frobnicate").returncode == 2


def test_it_gives_a_plan_and_pages_outside_a_checkout(installed):
    for words in (
        ("migrate", "--verbosity", "0"),
        ("load_world", "household", "--world", "home"),
        ("collectstatic", "--noinput", "--verbosity", "0"),
    ):
        done = installed.run("manage", *words)
        assert not done.returncode, done.stderr
    answer = installed.run("manage", "parse", "get me the tumbler", "--world", "home", "--json")
    assert not answer.returncode, answer.stderr
    assert json.loads(answer.stdout)["decision"] == "act"
    assert (installed.folder / "data" / "gpsr-workbench" / "db.sqlite3").is_file()
    asked = (
        "from django.test import Client; import annotations; c = Client(HTTP_HOST='localhost');"
        "print(c.get('/login/').status_code, annotations.__file__)"
    )
    status, file = installed.run("manage", "shell", "--verbosity", "0", "-c", asked).stdout.split()
    assert status == "200"
    assert Path(file).is_relative_to(installed.program.parents[1])


def test_a_build_without_the_front_end_stops(tmp_path):
    sources = copied_sources(tmp_path / "sources")
    shutil.rmtree(sources / "static" / "dist")
    done = built(sources, tmp_path)
    assert done.returncode
    assert "static/dist" in done.stderr + done.stdout
    assert not list(tmp_path.glob("*.whl"))


def test_workbench_and_client_have_one_version():
    versions = {
        tomllib.loads((folder / "pyproject.toml").read_text())["project"]["version"]
        for folder in (ROOT, ROOT / "clients" / "python")
    }
    assert len(versions) == 1
