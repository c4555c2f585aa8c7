"""What each route of the API takes in a body, read from the schema that the site gives out."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

from django.test import Client
from django.urls import resolve

from tests.gpsr_site.routes.listing import API_ROUTES

NAMES_IN_THE_SCHEMA = {"pk": "id"}
STAND_INS = {
    **{"world": "home", "id": "1", "run": "1", "split": "1"},
    **{"kind": "template", "handle": "none", "part": "grammar"},
}
JSON = "application/json"
WRITES = ("post", "patch", "put")


def numbered(path: str) -> str:
    """Return an address of the form of ``path``."""
    for name, value in STAND_INS.items():
        path = path.replace(f"{{{name}}}", value)
    return path


@dataclass(frozen=True)
class Body:
    """The JSON that a method of a route takes; ``fields`` are schemas by name."""

    route: str
    method: str
    fields: dict[str, Any]


@cache
def described() -> dict[str, Any]:
    answer = Client().get("/api/v1/schema/", headers={"accept": "application/vnd.oai.openapi+json"})
    return answer.json()


def resolved(schema: dict[str, Any]) -> dict[str, Any]:
    """Return a schema with what it refers to."""
    for reference in (schema.get("$ref"), *(each.get("$ref") for each in schema.get("allOf", ()))):
        if reference:
            return described()["components"]["schemas"][reference.rsplit("/", 1)[-1]]
    for some in ("oneOf", "anyOf"):
        if some in schema:
            return resolved(schema[some][0])
    return schema


@cache
def bodies() -> list[Body]:
    """Return the bodies of all routes that take JSON."""
    found = []
    for path, operations in described()["paths"].items():
        for method in set(operations) & set(WRITES):
            content = operations[method].get("requestBody", {}).get("content", {})
            if JSON in content:
                fields = resolved(content[JSON]["schema"]).get("properties", {})
                name = resolve(numbered(path)).view_name
                found.append(Body(name, method, fields))
    return sorted(found, key=lambda body: (body.route, body.method))


def example_of(schema: dict[str, Any], text: Callable[[str], str], free: str) -> Any:
    """Return a value that a field takes, each text in it passed through ``text``; ``free`` is one that
    may be anything."""
    schema = resolved(schema)
    kinds = schema.get("type", "string")
    kind = kinds if isinstance(kinds, str) else next(each for each in kinds if each != "null")
    if "enum" in schema:
        first = next(each for each in schema["enum"] if each not in ("", None))
        return text(first) if isinstance(first, str) else first
    match kind:
        case "integer" | "number":
            return schema.get("minimum", 1)
        case "boolean":
            return False
        case "array":
            return [example_of(schema.get("items", {}), text, free)]
        case "object":
            fields = schema.get("properties", {})
            filled = {text(name): example_of(each, text, free) for name, each in fields.items()}
            return filled or {text("colour"): text(free)}
    return text(free)


def routes_without_json() -> Iterator[str]:
    """Yield the routes that write and take no JSON."""
    taking = {body.route for body in bodies()}
    for name, route in API_ROUTES.items():
        if route.methods & set(WRITES) and name not in taking:
            yield name
