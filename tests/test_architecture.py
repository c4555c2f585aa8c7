"""Imports go one way: gpsr_site → parser_service → annotations → annotations.language."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from functools import cache
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

# The rooms of a package in the order of their imports: each may import only from rooms before it.
ROOMS = {
    "annotations": (
        "language", "models", "background", "jobs", "rows", "splits", "markdown", "form_presentation", "figures",
        "people", "lists", "generation", "checking", "suggesting", "importing", "exporting", "worlds", "world_archive",
        "editing", "renaming", "commenting", "labelling", "queueing", "utterances", "label_audit", "campaigns", "web",
        "templatetags",
    ),
    "annotations/web": (
        "sent_texts", "not_found", "problems", "forms", "rest", "background", "editing", "description", "corpus",
        "campaigns", "splits", "queueing", "people", "worlds",
    ),
    "annotations/models": (
        "short_texts", "people", "worlds", "background", "editing", "description", "campaigns", "corpus", "splits",
        "queueing",
    ),
    "annotations/language": (
        "errors", "limits", "text", "decoding", "english", "symbols", "forms", "grammar", "ontology", "predicates",
        "templates", "assistance", "suggestions", "grounding", "dialogue", "plans", "recipes", "names", "corpus",
        "paraphrases", "agreement", "label_errors",
    ),
    "parser_service/neural": (
        "device", "weights", "pretrained", "training", "word_vectors", "sentence_encoder", "seq2seq",
        "ranker", "t5",
    ),
    "parser_service/analysis": (
        "arrays", "encoded_labels", "answer_forms", "intervals", "clustered", "scores", "outcomes",
        "plan_agreement", "comparing", "slicing", "confusions", "categories", "attractors", "risk_coverage",
        "probabilities", "sureness", "edits", "sensitivity", "probe_texts",
    ),
    "parser_service/parsers": (
        "conditions", "hyperparameters", "interface", "storage", "registry", "words", "spreading", "remembering",
        "written_forms", "new_forms", "nearest_pairs", "knn", "linear", "oracle", "llm", "pretrained_files",
        "recommendation",
    ),
    "parser_service/runs": (
        "checkpoints", "orphan_folders", "lifecycle", "requests", "analysis_requests", "training", "curves", "waiting",
        "worker",
    ),
    "parser_service/analyses": (
        "stored_findings", "target", "attractor_findings", "plan_comparison", "probes", "refusal_curves",
        "analysis_job", "state",
        "tryout_answers",
    ),
    "gpsr_site": (
        "private_files", "sqlite", "settings", "broker", "consumer", "celery", "logs", "web", "wsgi",
        "accounts", "overview", "documents", "pages", "urls", "templatetags", "processes", "backup", "management",
    ),
    "parser_service": (
        "parsers", "neural", "analysis", "models", "promotions", "runs", "robots", "serving", "dialogues",
        "labelling", "results", "slices", "reviews", "analyses", "reports", "benchmarking", "label_audit",
        "paraphrasing",
    ),
    "parser_service/web": (
        "page_of_run", "runs", "results", "reviews", "analyses", "labelling", "promotions", "robots", "serving",
        "dialogues", "paraphrasing",
    ),
}  # fmt: skip


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


@pytest.mark.parametrize("folder", ROOMS)
def test_rooms_import_only_from_rooms_before_them(folder):
    order, package = ROOMS[folder], folder.replace("/", ".")
    for path in modules_below(folder):
        room = path.relative_to(ROOT / folder).with_suffix("").parts[0]
        if room not in order:
            continue  # addresses and commands look at every room
        for name in imports_of(path):
            other = name.removeprefix(f"{package}.").split(".")[0]
            if name.startswith(f"{package}.") and other != room:
                assert order.index(other) < order.index(room), f"{path} imports {name}"


def test_every_room_of_pages_and_routes_has_its_place():
    for folder in ("annotations/web", "parser_service/web"):
        rooms = {path.relative_to(ROOT / folder).parts[0] for path in modules_below(folder)}
        assert {room.removesuffix(".py") for room in rooms} - {"__init__"} == set(ROOMS[folder])


@pytest.mark.parametrize("app", ["annotations", "parser_service"])
def test_a_route_imports_no_page(app):
    """What both need, such as forms, filters and limits, stands below both."""
    for path in modules_below(f"{app}/web"):
        if path.stem.endswith("_rest") or path.parent.name == "rest":
            for name in imports_of(path):
                assert not name.endswith("_pages"), f"{path} imports {name}"


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


def test_jobs_know_no_verb():
    own = (
        "annotations.jobs",
        "annotations.background",
        "annotations.models",
        "annotations.language",
    )
    for path in modules_below("annotations/jobs"):
        for name in imports_of(path):
            assert (
                name.split(".")[0] not in OURS or name == "annotations" or name.startswith(own)
            ), f"{path} imports {name}"


def test_saving_a_template_loads_no_importer():
    script = (
        "import sys, django; django.setup(); import annotations.web.description.template_pages; "
        "sys.exit(' '.join(name for name in sys.modules "
        "if name.startswith(('annotations.importing', 'annotations.world_archive'))) or 0)"
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


def test_the_web_process_starts_without_torch_scipy_and_sklearn():
    script = (
        "import sys, gpsr_site.wsgi; from django.urls import get_resolver; "
        "get_resolver().url_patterns; "
        "sys.exit(' '.join({'torch', 'scipy', 'sklearn'} & {*sys.modules}) or 0)"
    )
    subprocess.run([sys.executable, "-c", script], cwd=ROOT, check=True)
