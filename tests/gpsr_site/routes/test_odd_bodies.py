"""Whatever a body holds, the answer is never an error of the server.

Routes, methods and fields are read from the schema that the site gives out, so that new ones are tried too.
"""

from __future__ import annotations

import json
import re

import pytest
from django.db import transaction

from tests.gpsr_site.routes.addresses import address
from tests.gpsr_site.routes.bodies import bodies, example_of
from tests.gpsr_site.routes.listing import ALL_ROUTES, API_ROUTES
from tests.sample_world import SampleWorld

JSON = "application/json"
# As they are written in JSON: Python's own writer cannot write all of them.
VALUES = {
    "lone surrogate": '"\\ud83d"',
    "NUL": '"a\\u0000b"',
    "2^63": str(2**63),
    "10^30": str(10**30),
    "texts of numbers": f'"{10**30}"',
    "NaN": "NaN",
    "infinite": "1e400",
    "list of all": f'["\\ud83d", {2**63}, {10**30}, null, {{}}, []]',
    "list of keys": f"[{2**63}]",
    "object": f'{{"\\ud83d": {10**30}}}',
    "nested": "[" * 70 + "]" * 70,
    "null": "null",
}
WHOLE = {
    "deep lists": b"[" * 100_000,
    "deep objects": b'{"a":' * 100_000,
    "closed": b"[" * 100_000 + b"]" * 100_000,
    "surrogate as a name": b'{"\\ud83d": 1}',
    "NUL as a name": b'{"a\\u0000": 1}',
    "not UTF-8": b'{"a": "\xff\xfe"}',
    "half a surrogate in UTF-8": b'{"a": "\xed\xa0\x80"}',
    "UTF-16": '{"a": 1}'.encode("utf-16"),
    "NaN": b"NaN",
    "number": b"1e400",
    "long number": b"9" * 5000,
    "text": b'"\\ud83d"',
    "empty": b"",
}
METHODS = ("post", "patch", "put", "delete")
WRITES = sorted(
    (name, method) for name, route in API_ROUTES.items() for method in route.methods & set(METHODS)
)
LARGE = (2**63, 10**30)


@pytest.fixture
def root(client_as, monkeypatch):
    monkeypatch.setattr("annotations.background.waking.send_wake_up", lambda queue: None)
    return client_as("superuser")


def send(root, method: str, path: str, body: bytes | str) -> None:
    with transaction.atomic():  # the next request finds the rows that this one deletes
        answer = root.generic(method, path, body, JSON, headers={"if-match": "*"})
        if answer.streaming:
            b"".join(answer.streaming_content)
        transaction.set_rollback(True)
    # 503 is the parse server's, which is not there.
    assert answer.status_code in (*range(500), 503), (method, path, body[:100], answer.content)
    answer.content.decode()


@pytest.mark.parametrize("value", VALUES.values(), ids=VALUES)
def test_odd_values_in_each_field_of_each_body(value, sample: SampleWorld, root):
    for body in bodies():
        path = address(body.route, sample)
        sent = {name: example_of(each, str, "go") for name, each in body.fields.items()}
        for name in sent:
            others = {key: each for key, each in sent.items() if key != name}
            written = json.dumps(others).rstrip("}") + (", " if others else "")
            send(root, body.method, path, f"{written}{json.dumps(name)}: {value}}}")
        send(root, body.method, path, f'{{"unknown": {value}}}')


@pytest.mark.parametrize("body", WHOLE.values(), ids=WHOLE)
def test_odd_bodies_of_each_route(body, sample: SampleWorld, root):
    for name, method in WRITES:
        send(root, method, address(name, sample), body)


@pytest.mark.parametrize("number", LARGE, ids=["2^63", "10^30"])
def test_keys_beyond_what_the_database_holds_name_nothing(number, sample: SampleWorld, root):
    for name, path in ALL_ROUTES.items():
        if "<int:" not in path or name == "admin:index":
            continue
        there = re.sub(r"/\d+/", f"/{number}/", address(name, sample))
        for method in ("get", *METHODS):
            answer = root.generic(method, there, b"{}", JSON, headers={"if-match": "*"})
            assert answer.status_code in range(400, 500), (method, there, answer.status_code)


QUERY_NAMES = (
    "run",
    "split",
    "id",
    "user",
    "reviewer",
    "template",
    "limit",
    "sort",
    "after",
    "beam",
)


@pytest.mark.parametrize("number", [*LARGE, "%ED%A0%80", "a%00b", "NaN"], ids=str)
def test_odd_values_in_the_query_of_each_route(number, sample: SampleWorld, root):
    for name, route in API_ROUTES.items():
        filters = getattr(getattr(route.view, "filterset_class", None), "base_filters", {})
        query = "&".join(f"{each}={number}" for each in {*filters, *QUERY_NAMES})
        path = address(name, sample)
        for parts in (query, *(f"{each}={number}" for each in filters)):
            answer = root.get(f"{path}{'&' if '?' in path else '?'}{parts}")
            if answer.streaming:
                b"".join(answer.streaming_content)
            assert answer.status_code in (*range(500), 503), (path, parts)
