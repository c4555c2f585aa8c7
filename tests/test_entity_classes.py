"""No module lists the classes of entities: they are data of a world, and one file says what a new world starts with.

A list is a literal in which three of the eight default classes, or more, stand beside each other: elements of a list, a
tuple or a set, alternatives of a regular expression, members of an enumeration. Two are a relation of the language,
which code may be about: a location is in a room, an object is of a category. For the same reason a table may have up
to three classes as keys, each with what is special about it, such as the types of its wildcards; all other classes
have what its reader falls back to.
"""

from __future__ import annotations

import ast
import json
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from annotations.language.forms import DEFAULT_CLASSES
from annotations.language.forms.entity_classes import RESERVED
from annotations.language.world import ArgumentKind

ROOT = Path(__file__).resolve().parent.parent
ROOMS = (
    "annotations",
    "parser_service",
    "gpsr_site",
    "static/src",
    "static/css",
    "clients",
    "templates",
)
THE_FILE = ROOT / "annotations/language/forms/entity_classes.toml"
# What the files of others, and the commands in them, are made of; and what the classes of those worlds mean.
TEXTS = (
    "annotations/starter",
    "annotations/language/texts/data/sample_commands.toml",
    "annotations/language/forms/meanings.toml",
)
TOKENS = frozenset(DEFAULT_CLASSES.tokens)
MOST_IN_A_LIST, MOST_KEYS = 2, 3
# Class names in a row, with quotation marks, commas, bars, colons and the like between them.
_NAME = rf"\b(?:{'|'.join(sorted(TOKENS))})\b"
IN_A_ROW = re.compile(rf"{_NAME}(?:[\s\"'`,|:;()<>{{}}=-]{{1,12}}{_NAME}){{2,}}")


def files() -> list[Path]:
    found = []
    for room in ROOMS:
        for path in sorted((ROOT / room).rglob("*")):
            name = path.relative_to(ROOT).as_posix()
            is_text = path.suffix in (".py", ".js", ".css", ".toml", ".json", ".lark", ".html")
            if is_text and path != THE_FILE and not name.startswith(TEXTS):
                found.append(path)
    return found


def lists_in_python(text: str) -> Iterator[set[str]]:
    for node in ast.walk(ast.parse(text)):
        named: set[str] = set()
        most = MOST_IN_A_LIST
        if isinstance(node, ast.List | ast.Tuple | ast.Set):
            named = {each.value for each in node.elts if isinstance(each, ast.Constant)} & TOKENS
        elif isinstance(node, ast.Dict):
            named = {each.value for each in node.keys if isinstance(each, ast.Constant)} & TOKENS
            most = MOST_KEYS
        elif isinstance(node, ast.ClassDef):
            values = (each.value for each in node.body if isinstance(each, ast.Assign))
            named = {each.value for each in values if isinstance(each, ast.Constant)} & TOKENS
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            named = {word for part in node.value.split() for word in part.split("|")} & TOKENS
            named = named if "|" in node.value else set()
        if len(named) > most:
            yield named


def lists_in_data(value: Any) -> Iterator[set[str]]:
    if isinstance(value, dict):
        if len(TOKENS & value.keys()) > MOST_KEYS:
            yield TOKENS & value.keys()
        for each in value.values():
            yield from lists_in_data(each)
    elif isinstance(value, list):
        named = TOKENS & {each for each in value if isinstance(each, str)}
        if len(named) > MOST_IN_A_LIST:
            yield named
        for each in value:
            yield from lists_in_data(each)


def lists_in(path: Path) -> list[set[str]]:
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".py":
        return list(lists_in_python(text))
    if path.suffix == ".toml":
        return list(lists_in_data(tomllib.loads(text)))
    if path.suffix == ".json":
        return list(lists_in_data(json.loads(text)))
    rows = (set(re.findall(_NAME, match[0])) for match in IN_A_ROW.finditer(text))
    return [named for named in rows if len(named) > MOST_IN_A_LIST]


def test_no_module_lists_the_classes():
    found = {path.relative_to(ROOT).as_posix(): lists_in(path) for path in files()}
    assert len(found) > 900
    assert {name: lists for name, lists in found.items() if lists} == {}


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.py", 'X = ("room", "object", "name")'),
        ("a.py", 'X = {"room": 1, "object": 2, "name": 3, "gesture": 4}'),
        ("a.py", 'class X:\n    ROOM = "room"\n    NAME = "name"\n    OBJECT = "object"'),
        ("a.py", 'X = re.compile(r"room|name|object")'),
        ("a.js", 'const X = ["room", "object", "name"];'),
        ("a.toml", 'x = ["room", "object", "name"]'),
        ("a.json", '{"enum": ["room", "object", "name"]}'),
    ],
)
def test_a_list_is_found(tmp_path, name, text):
    path = tmp_path / name
    path.write_text(text)
    assert lists_in(path)


def test_no_class_can_have_a_word_of_the_language():
    assert set(ArgumentKind) < RESERVED
    assert not {"object", "pose"} & RESERVED
