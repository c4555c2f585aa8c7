"""A package of somebody else adds a parser by an entry point alone (docs/design/parsers.md)."""

from __future__ import annotations

import os
import subprocess
import sys
import tomllib
from importlib.metadata import distribution
from pathlib import Path

import pytest

from parser_service.parsers import registry
from tests.parser_service.made_up import make_split
from tests.parser_service.runs.test_train_run import trained

ROOT = Path(__file__).resolve().parents[2]
REGISTERED = """
from parser_service.parsers.registry_entry import RegistryEntry

PARSERS = {
    "acme": RegistryEntry(
        dotted="acme_parsers.parser.Acme",
        config="acme_parsers.config.AcmeConfig",
        title="Acme", description="Answers as Acme would.", version=1, protocols=("strict",),
        after="knn",
    ),
}
"""
CONFIG = """
from dataclasses import dataclass

@dataclass(frozen=True)
class AcmeConfig:
    pass
"""
PARSER = """
from acme_parsers.config import AcmeConfig
from tests.parser_service.test_adding_a_parser import MostFrequent

class Acme(MostFrequent):
    name, Config = "acme", AcmeConfig
"""


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A package that is installed, with its entry point; returns its folder."""
    info, code = tmp_path / "acme_tools-1.0.dist-info", tmp_path / "acme_parsers"
    info.mkdir()
    code.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: acme-tools\nVersion: 1.0\n")
    point = f"[{registry.GROUP}]\nacme = acme_parsers.registered:PARSERS\n"
    (info / "entry_points.txt").write_text(point)
    (code / "__init__.py").touch()
    for name, text in (("registered", REGISTERED), ("config", CONFIG), ("parser", PARSER)):
        (code / f"{name}.py").write_text(text)
    monkeypatch.syspath_prepend(tmp_path)
    yield code
    for name in [each for each in sys.modules if each.split(".")[0] == "acme_parsers"]:
        del sys.modules[name]


def test_the_installed_package_registers_what_the_project_says():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    installed = distribution(project["name"]).entry_points.select(group=registry.GROUP)
    named = project["entry-points"][registry.GROUP]
    assert {each.name: each.value for each in installed} == named, "run make install"


def test_a_registered_parser_is_offered_and_trains(
    package, world, transactional_db, monkeypatch, adam
):
    in_order = registry._in_order(registry._registered())
    names = list(in_order)
    assert names[names.index("knn") + 1] == "acme"
    assert [each for each in names if each != "acme"] == list(registry.parsers())
    monkeypatch.setitem(registry.parsers(), "acme", in_order["acme"])
    split = make_split(world)
    page = adam.get("/w/home/runs/new/", {"parser": "acme"}).content.decode()
    assert "Answers as Acme would." in page
    run = trained(split, "acme")
    assert (run.status, run.failure) == ("succeeded", "")


def run_help(package):
    places = os.pathsep.join([str(package.parent), *filter(None, sys.path)])
    return subprocess.run(
        [sys.executable, "manage.py", "train", "--help"],
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": places},
        capture_output=True,
        text=True,
        check=True,
    )


def test_a_command_offers_it(package):
    told = run_help(package)
    assert "knn,acme,linear" in told.stdout and not told.stderr


def test_a_command_says_once_what_cannot_be_loaded(package):
    (package / "registered.py").write_text("import no_such_module")
    told = run_help(package)
    assert "acme" not in told.stdout and "knn,linear" in told.stdout
    assert told.stderr.count("acme-tools") == 1


@pytest.mark.parametrize(
    ("file", "old", "new", "said"),
    [
        ("registered", "from parser", "import no_such_module\nfrom parser", "no_such_module"),
        ("registered", "PARSERS =", "OTHERS =", "PARSERS"),
        ("registered", '"acme": R', '"knn": R', "there is a parser 'knn' already"),
        ("registered", 'after="knn"', 'queue="fast"', "the queue 'fast'"),
        ("registered", "title=", "name=", "name"),
        ("config", "class AcmeConfig", "class Other", "AcmeConfig"),
        ("config", "@dataclass(frozen=True)", "", "dataclass"),
    ],
)
def test_parsers_that_cannot_be_used_are_left_out_and_their_package_is_named(
    package, caplog, file, old, new, said
):
    path = package / f"{file}.py"
    assert old in path.read_text()
    path.write_text(path.read_text().replace(old, new, 1))
    assert registry._in_order(registry._registered()) == registry.parsers()
    [record] = caplog.records
    told = record.getMessage()
    assert told.startswith("The parsers that the package acme-tools registers as acme_parsers.")
    assert said in told and told.endswith("All others go on.")
