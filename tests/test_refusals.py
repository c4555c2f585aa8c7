"""What a person did wrong is a Refusal, and no page, route or command shows another error's words."""

from __future__ import annotations

import ast
import importlib
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest
from django.core.exceptions import ValidationError

from annotations.language.texts.errors import Refusal

ROOT = Path(__file__).parents[1]
MODULES = [
    path.relative_to(ROOT).as_posix()
    for app in ("annotations", "parser_service", "gpsr_site")
    for path in sorted((ROOT / app).rglob("*.py"))
    if "migrations" not in path.relative_to(ROOT).parts
]
# Modules that check what a programmer gives them.
CHECK_ARGUMENTS = (
    "parser_service/analysis/",
    "parser_service/results/selecting.py",
    "parser_service/parsers/linear.py",
    "parser_service/parsers/short.py",
    "parser_service/neural/ranker/form_ranker.py",
    "parser_service/neural/t5/spelling.py",
    "parser_service/neural/t5/t5_parser.py",
)
SPEAK_TO_PEOPLE = tuple(
    f"{app}/{room}/"
    for app in ("annotations", "parser_service", "gpsr_site")
    for room in (
        *("web", "management", "serving", "labelling", "reviews", "people", "background", "backup"),
    )
)
WORDS_OF = ("str", "repr", "format")


@cache
def read(module: str) -> ast.Module:
    return ast.parse((ROOT / module).read_text(encoding="utf-8"))


def raises_value_error(tree: ast.Module) -> list[int]:
    """Return the lines that raise a bare ValueError."""
    raised = [node for node in ast.walk(tree) if isinstance(node, ast.Raise) and node.exc]
    return [node.lineno for node in raised if ast.unparse(node.exc).startswith("ValueError")]


def shown_errors(tree: ast.Module) -> Iterator[ast.ExceptHandler]:
    """Yield the handlers that make a text of the error that they catch."""
    for handler in ast.walk(tree):
        if not isinstance(handler, ast.ExceptHandler) or not handler.name:
            continue
        for node in ast.walk(handler):
            texts: list[ast.expr] = []
            if isinstance(node, ast.FormattedValue):
                texts = [node.value]
            elif isinstance(node, ast.Call) and ast.unparse(node.func) in WORDS_OF:
                texts = node.args
            if any(isinstance(text, ast.Name) and text.id == handler.name for text in texts):
                yield handler
                break


def caught_by(handler: ast.ExceptHandler, module: str) -> tuple[type[BaseException], ...]:
    """Return the classes that a handler catches."""
    name = module.removesuffix(".py").removesuffix("/__init__").replace("/", ".")
    caught = eval(ast.unparse(handler.type), vars(importlib.import_module(name)))
    return caught if isinstance(caught, tuple) else (caught,)


def test_what_a_person_did_wrong_is_a_refusal():
    lines = {each: raises_value_error(read(each)) for each in MODULES}
    assert not {
        each: raised
        for each, raised in lines.items()
        if raised and not each.startswith(CHECK_ARGUMENTS)
    }


@pytest.mark.parametrize("module", CHECK_ARGUMENTS)
def test_modules_that_check_arguments_are_listed_while_they_do(module):
    some = [each for each in MODULES if each.startswith(module)]
    assert any(raises_value_error(read(each)) for each in some)


def test_only_a_refusal_is_shown_in_its_own_words():
    shown = [
        (f"{module}:{handler.lineno}", each.__name__)
        for module in MODULES
        if module.startswith(SPEAK_TO_PEOPLE)
        for handler in shown_errors(read(module))
        for each in caught_by(handler, module)
        if not issubclass(each, Refusal | ValidationError)
    ]
    assert shown == []
