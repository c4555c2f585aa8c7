"""Imports go one way: gpsr_site → parser_service → annotations → annotations.language."""

from __future__ import annotations

import ast
import importlib
import os
import re
import subprocess
import sys
import tomllib
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
OURS = ("gpsr_site", "parser_service", "annotations")

# What the modules below a package may not import.
FORBIDDEN = {
    "annotations/language": ("django", "rest_framework", "torch", "transformers", "pandas"),
    "annotations": ("parser_service", "gpsr_site", "torch", "transformers"),
    "parser_service": ("gpsr_site",),
    "parser_service/neural": ("django", "rest_framework"),
    "parser_service/parsers": ("django", "rest_framework", "torch", "transformers"),
    "parser_service/analysis": ("django", "rest_framework", "torch", "transformers"),
}
# Of our own code, these import nothing but the language core and themselves.
LANGUAGE_ONLY = ("parser_service/parsers", "parser_service/neural", "parser_service/analysis")
THEIR_OWN = (
    "annotations.language",
    "parser_service.parsers",
    "parser_service.neural",
    "parser_service.analysis",
)

# The rooms of a package in the order of their imports: each may import only from rooms before it. Addresses,
# admin, commands and app configs look at every room.
ROOMS = {
    "annotations": (
        "language", "models", "background", "people", "rows", "generation", "showing", "exchange", "editing",
        "labelling", "campaigns", "web", "templatetags", "management",
    ),
    "annotations/language": (
        "texts", "forms", "grammar", "world", "grounding", "templates", "induction", "corpus", "plans",
    ),
    "annotations/web": (
        "rest", "editing", "worlds", "corpus", "description", "labelling", "people", "campaigns",
    ),
    "parser_service": (
        "parsers", "analysis", "neural", "models", "runs", "serving", "labelling", "results", "reviews",
        "benchmarking", "web", "templatetags", "management",
    ),
    "parser_service/parsers": ("hyperparameters", "model_server", "llm"),
    "parser_service/neural": (
        "sentence_encoder", "t5", "word_vectors", "ranker", "seq2seq", "elmo", "gpt",
    ),
    "parser_service/web": ("runs", "serving", "labelling", "results", "reviews"),
    "gpsr_site": (
        "sqlite", "web", "accounts", "overview", "pages", "templatetags", "backup", "management",
    ),
}  # fmt: skip
ENTERED_BY_ALL = ("templatetags", "management")
NO_ROOMS = ("migrations", "starter", "__pycache__")


@cache
def imports_of(path: Path) -> set[str]:
    """The dotted names that a module imports, anywhere in it."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            names.add(node.module)
            names.update(
                f"{node.module}.{alias.name}" for alias in node.names if _is_ours(node, alias)
            )
    return names


def _is_ours(node: ast.ImportFrom, alias: ast.alias) -> bool:
    """Whether ``from a.b import c`` names a module."""
    return (ROOT / node.module.replace(".", "/") / alias.name).with_suffix(".py").is_file() or (
        ROOT / node.module.replace(".", "/") / alias.name
    ).is_dir()


@cache
def strings_of(path: Path) -> set[str]:
    """The texts that a module writes as they are."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    constants = {node.value for node in ast.walk(tree) if isinstance(node, ast.Constant)}
    return {each for each in constants if isinstance(each, str)}


def dotted(path: Path) -> str:
    return ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


@cache
def modules_below(folder: str) -> list[Path]:
    return sorted((ROOT / folder).rglob("*.py"))


@pytest.mark.parametrize("folder", FORBIDDEN)
def test_no_module_imports_what_its_layer_may_not(folder):
    for path in modules_below(folder):
        for name in imports_of(path):
            assert name.split(".")[0] not in FORBIDDEN[folder], f"{path} imports {name}"


def test_the_language_core_imports_nothing_else_of_ours():
    for path in modules_below("annotations/language"):
        for name in imports_of(path):
            if name.split(".")[0] in OURS:
                assert name.startswith("annotations.language"), f"{path} imports {name}"


@pytest.mark.parametrize("folder", LANGUAGE_ONLY)
def test_parsers_networks_and_analysis_know_only_the_language_core(folder):
    for path in modules_below(folder):
        for name in imports_of(path):
            if name.split(".")[0] in OURS:
                assert name.startswith(THEIR_OWN), f"{path} imports {name}"


def rooms_in(folder: str) -> set[str]:
    """The packages right below a folder; one without modules, such as a folder of data, is none."""
    below = {path.parent for path in (ROOT / folder).glob("*/*.py")}
    return {path.name for path in below} - set(NO_ROOMS)


@pytest.mark.parametrize("folder", ROOMS)
def test_rooms_import_only_from_rooms_before_them(folder):
    order, package = ROOMS[folder], folder.replace("/", ".")
    for room in order:
        for path in modules_below(f"{folder}/{room}"):
            for name in imports_of(path):
                other = name.removeprefix(f"{package}.").split(".")[0]
                if name.startswith(f"{package}.") and other != room and other in order:
                    assert order.index(other) < order.index(room), f"{path} imports {name}"


def test_every_room_has_its_place():
    folders = {str(path.parent.relative_to(ROOT)) for each in OURS for path in modules_below(each)}
    for folder in folders:
        found = set() if folder.endswith(NO_ROOMS + ENTERED_BY_ALL) else rooms_in(folder)
        assert found == set(ROOMS.get(folder, ())), folder


def test_the_table_of_the_documents_has_every_room():
    text = (ROOT / "docs/design/architecture.md").read_text(encoding="utf-8")
    named = {
        each
        for line in re.findall(r"^\| (`.*?) \|", text, re.M)
        for each in re.findall(r"`(.+?)`", line)
    }
    rooms = {f"{folder}/{room}" for folder, order in ROOMS.items() for room in order}
    assert {each for each in named if each.startswith(OURS)} >= rooms
    assert {each for each in named if each.startswith(OURS) and not (ROOT / each).exists()} == set()


def test_no_module_needs_one_that_needs_it():
    modules = {dotted(path): path for each in OURS for path in modules_below(each)}
    arrows = {
        name: {other for other in imports_of(path) if other in modules and other != name}
        for name, path in modules.items()
        if path.name != "__init__.py"  # whoever enters by a front door gets all that it offers
    }
    assert TopologicalSorter(arrows).prepare() is None


@pytest.mark.parametrize("app", ["annotations", "parser_service"])
def test_a_route_imports_no_page(app):
    """What both need, such as forms, filters and limits, stands below both."""
    for path in modules_below(f"{app}/web"):
        if path.stem.endswith("_rest") or path.parent.name == "rest":
            for name in imports_of(path):
                assert not name.endswith(("_pages", "_noun", ".nouns")), f"{path} imports {name}"


def test_only_what_a_request_or_a_command_enters_imports_pages_and_routes():
    """Models and verbs do their work for whoever calls them."""
    for app in ("annotations", "parser_service"):
        for path in modules_below(app):
            room = path.relative_to(ROOT / app).parts[0]
            if room in ("web", "templatetags", "management") or room.endswith("urls.py"):
                continue
            for name in imports_of(path):
                assert name.split(".")[1:2] != ["web"], f"{path} imports {name}"


@pytest.mark.parametrize("package", ["annotations/language", "annotations/models"])
def test_a_room_is_entered_by_its_front_door(package):
    rooms = {path.name for path in (ROOT / package).iterdir() if path.is_dir()}
    dotted = package.replace("/", ".")
    for folder in OURS:
        for path in modules_below(folder):
            for name in imports_of(path):
                room, _, module = name.removeprefix(f"{dotted}.").partition(".")
                is_inside = ROOT / package / room in path.parents
                if name.startswith(f"{dotted}.") and room in rooms and not is_inside:
                    assert not module, f"{path} imports {name}, not {dotted}.{room}"


def test_a_network_imports_nothing_of_another_one():
    networks = {"seq2seq", "ranker", "t5"}
    for network in networks:
        for path in modules_below(f"parser_service/neural/{network}"):
            for name in imports_of(path):
                room = name.removeprefix("parser_service.neural.").split(".")[0]
                assert room not in networks - {network}, f"{path} imports {name}"


def registered_modules() -> list[str]:
    """The modules that give the rows which are registered by entry points, as a third party's would be."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    points = project["entry-points"]["gpsr_workbench.parsers"].values()
    return [each.partition(":")[0] for each in points]


@pytest.mark.parametrize("module", registered_modules())
def test_nothing_knows_a_parser_that_an_entry_point_registers(module):
    package = module.rpartition(".")[0]
    rows = importlib.import_module(module).PARSERS
    for folder in OURS:
        for path in modules_below(folder):
            if ROOT / package.replace(".", "/") in path.parents:
                continue
            for name in imports_of(path):
                assert not f"{name}.".startswith(f"{package}."), f"{path} imports {name}"
            if folder != "gpsr_site":  # the settings name folders
                assert not strings_of(path) & rows.keys(), path


@pytest.mark.parametrize("module", registered_modules())
def test_what_an_entry_point_registers_loads_no_torch(module):
    script = f"import sys, {module}; sys.exit('torch' in sys.modules)"
    subprocess.run([sys.executable, "-c", script], cwd=ROOT, check=True)


@pytest.mark.parametrize("folder", OURS)
def test_what_a_front_door_offers_is_not_hidden_by_a_module_of_the_same_name(folder):
    """The first import of ``a.b`` puts the module where the function ``b`` of package ``a`` was."""
    for door in (ROOT / folder).rglob("__init__.py"):
        offered = {
            alias.asname or alias.name
            for node in ast.walk(ast.parse(door.read_text(encoding="utf-8")))
            if isinstance(node, ast.ImportFrom)
            for alias in node.names
            if not (node.module or "").endswith(f".{alias.name}")  # imported before it is hidden
        }
        beside = {path.stem for path in door.parent.iterdir()} - {"__init__"}
        assert not offered & beside, door


def test_background_work_knows_no_verb():
    own = ("annotations.background", "annotations.models", "annotations.language")
    for path in modules_below("annotations/background"):
        for name in imports_of(path):
            if name.split(".")[0] in OURS and name not in ("annotations", "annotations.apps"):
                assert name.startswith(own), f"{path} imports {name}"


def test_saving_a_template_loads_no_importer():
    script = (
        "import sys, django; django.setup(); import annotations.web.description.template_pages; "
        "sys.exit(' '.join(name for name in sys.modules "
        "if name.startswith('annotations.exchange.') and 'import' in name) or 0)"
    )
    settings = {"DJANGO_SETTINGS_MODULE": "gpsr_site.settings"}
    subprocess.run(
        [sys.executable, "-c", script], cwd=ROOT, check=True, env={**os.environ, **settings}
    )


def test_every_relation_between_modules_is_spelled_absolutely():
    for folder in OURS:
        for path in modules_below(folder):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.ImportFrom):
                    assert not node.level, f"{path} has a relative import"


def test_the_web_process_starts_without_torch_scipy_sklearn_and_pandas():
    script = (
        "import sys, gpsr_site.wsgi; from django.urls import get_resolver; "
        "get_resolver().url_patterns; "
        "sys.exit(' '.join({'torch', 'scipy', 'sklearn', 'pandas'} & {*sys.modules}) or 0)"
    )
    subprocess.run([sys.executable, "-c", script], cwd=ROOT, check=True)
