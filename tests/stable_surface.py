"""What other programs build on, as names: python -m tests.stable_surface writes tests/stable-1.json.

docs/reference/stability.md promises that it only grows within version 1. Each line is a name with what belongs to it:
of an operation of the API ``?parameter``, ``>field`` of its answer and ``!field`` that its body needs.
"""

from __future__ import annotations

import dataclasses
import importlib
import inspect
import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

FILE = Path(__file__).with_name("stable-1.json")
METHODS = ("get", "post", "put", "patch", "delete")
OURS = ("annotations", "parser_service", "gpsr_site")

Surface = dict[str, dict[str, list[str]]]


def surface() -> Surface:
    """Return kind → name → what belongs to it."""
    from annotations.exchange.split_export import FIELDS, SplitFormat
    from tests.problem_page import read_codes
    from tests.test_docs import variables_of_the_settings

    exports = {"fields": [str(each) for each in FIELDS], "formats": list(SplitFormat.values)}
    return {
        "rest": dict(_operations()),
        "codes": {each: [] for each in sorted(read_codes())},
        "commands": dict(_commands()),
        "client": dict(_client()),
        "export": exports,
        "variables": {each: [] for each in sorted(variables_of_the_settings())},
    }


def read_stored() -> Surface:
    """Return what the file has."""
    stored = json.loads(FILE.read_text(encoding="utf-8"))
    return {
        kind: {name: words.split() for name, words in names.items()}
        for kind, names in stored.items()
    }


def _operations() -> Iterator[tuple[str, list[str]]]:
    from drf_spectacular.generators import SchemaGenerator

    schema: Mapping[str, Any] = SchemaGenerator().get_schema(request=None, public=True)  # type: ignore[no-untyped-call]
    for path, methods in sorted(schema["paths"].items()):
        for method in (each for each in METHODS if each in methods):
            operation = methods[method]
            asked = operation.get("parameters", ())
            answers = [
                field
                for status, response in operation["responses"].items()
                for field in _json_of(response, schema).get("properties", ())
                if status.startswith("2")
            ]
            needed = _json_of(operation.get("requestBody", {}), schema).get("required", ())
            yield (
                f"{method.upper()} {path}",
                [
                    *(f"?{each['name']}" for each in asked if each["in"] == "query"),
                    *(f">{each}" for each in dict.fromkeys(answers)),
                    *(f"!{each}" for each in needed),
                ],
            )


def _json_of(part: Mapping[str, Any], schema: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the schema of the object that is sent or answered; of a list, that of its rows."""
    found: Mapping[str, Any] = part.get("content", {}).get("application/json", {}).get("schema", {})
    while True:
        if "$ref" in found:
            found = schema["components"]["schemas"][found["$ref"].rpartition("/")[2]]
        elif "items" in found:
            found = found["items"]
        elif "results" in found.get("properties", {}):
            found = found["properties"]["results"]
        else:
            return found


def _commands() -> Iterator[tuple[str, list[str]]]:
    from django.core.management import BaseCommand, get_commands, load_command_class

    everywhere = set(BaseCommand().create_parser("", "")._option_string_actions)
    for name, app in sorted(get_commands().items()):
        if app in OURS:
            parser = load_command_class(app, name).create_parser("", name)
            yield name, sorted(set(parser._option_string_actions) - everywhere)


def _client() -> Iterator[tuple[str, list[str]]]:
    client = importlib.import_module("gpsr_client")
    for name in sorted(client.__all__):
        kind = getattr(client, name)
        names = (
            {field.name for field in dataclasses.fields(kind)}
            if dataclasses.is_dataclass(kind)
            else set()
        )
        for member, value in vars(kind).items():
            if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                names.add(member)
                if callable(value) and not dataclasses.is_dataclass(kind):
                    names |= {f"{member}:{each}" for each in inspect.signature(value).parameters}
        yield name, sorted(names)


if __name__ == "__main__":
    import django

    django.setup()
    now = {
        kind: {name: " ".join(words) for name, words in names.items()}
        for kind, names in surface().items()
    }
    FILE.write_text(json.dumps(now, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
