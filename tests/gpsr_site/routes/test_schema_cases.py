"""Requests that Schemathesis makes from the schema: whatever is sent, the server has no error.

``TEST_SCHEMA_CASES`` says how many, all operations together.
"""

from __future__ import annotations

import os
from collections import Counter
from dataclasses import dataclass
from math import ceil
from typing import Any

import pytest
from django.db import transaction
from django.test import Client
from django.urls import Resolver404, resolve
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from annotations.models import ApiToken, Notice
from annotations.people.accounts import sessions_of
from annotations.web.rest.streaming import JSON_LINES
from parser_service.runs.promoting import promote
from tests.filled_world import save_parser
from tests.gpsr_site.routes.addresses import KEYS, RouteKeys
from tests.gpsr_site.routes.bodies import NAMES_IN_THE_SCHEMA, numbered
from tests.parser_service.live_server import parse_server  # noqa: F401
from tests.sample_world import SampleWorld, comment_in

CASES = int(os.environ.get("TEST_SCHEMA_CASES", "60"))
WRITES = {"post": 4, "patch": 4, "delete": 1, "get": 2}  # how often one is tried beside the others


@pytest.fixture
def operations():
    schemathesis = pytest.importorskip("schemathesis")
    schemathesis.serializer.alias(JSON_LINES, "text/plain")
    described = Client().get("/api/v1/schema/", headers={"accept": "application/json"}).json()
    results = [*schemathesis.openapi.from_dict(described).get_all_operations()]
    step = -(
        -len(results) // CASES
    )  # with fewer cases than operations, some of these from all over
    return [result.ok() for result in results[::step]]


@pytest.fixture
def answering(sample, parse_server) -> None:  # noqa: F811
    """The run of the sample world has a parser, with which the parse server answers."""
    save_parser(sample.run)
    promote(sample.run, None)
    parse_server.update()


@pytest.fixture
def keys(sample, superuser, logged_in_people) -> dict[str, RouteKeys]:
    """The keys of each route, with rows of the caller's own where a route is about these."""
    comment = comment_in(sample.world)
    notice, _ = Notice.objects.get_or_create(comment=comment, user=superuser, is_mention=True)
    token, _ = ApiToken.issue(superuser, "notebook")
    handle = sessions_of(superuser)[0].handle
    return {
        **KEYS,
        "api:token-detail": lambda _: {"pk": token.pk},
        "api:session": lambda _: {"handle": handle},
        "api:notice-read": lambda _: {"pk": notice.pk},
    }


def test_no_request_is_an_error_of_the_server(
    operations, sample, superuser, answering, keys, monkeypatch
):
    monkeypatch.setattr("annotations.background.waking.send_wake_up", lambda queue: None)
    monkeypatch.setattr("annotations.background.requesting.keep_uploads", lambda uploads: None)
    _, key = ApiToken.issue(superuser, "robot")
    caller = Caller(Client(raise_request_exception=False), key, sample, keys)
    share = CASES / sum(WRITES[each.method] for each in operations)
    statuses: Counter[int] = Counter()
    for operation in operations:
        statuses += ask(caller, operation, ceil(share * WRITES[operation.method]))
    print(f"{statuses.total():,} requests of {len(operations)} operations: {statuses}")
    assert statuses.total() >= min(CASES, len(operations))
    assert {200, 400} <= set(statuses), dict(statuses)


@dataclass(frozen=True)
class Caller:
    """Who asks, with a token, about the rows of which world."""

    client: Client
    token: str
    sample: SampleWorld
    keys: dict[str, RouteKeys]


def ask(caller: Caller, operation: Any, count: int) -> Counter[int]:
    """Send ``count`` requests of one operation, most of them about rows that are there."""
    statuses: Counter[int] = Counter()
    mostly = st.sampled_from([True, True, True, False])

    @settings(
        max_examples=count,
        database=None,
        deadline=None,
        derandomize=True,
        suppress_health_check=list(HealthCheck),
    )
    @given(st.tuples(operation.as_strategy(), mostly, mostly))
    def send(drawn: Any) -> None:
        with transaction.atomic():  # the next request finds the rows that this one deletes
            answer = answer_to(caller, *drawn)
            transaction.set_rollback(True)
        statuses[answer.status_code] += 1

    send()
    return statuses


def answer_to(caller: Caller, case: Any, is_there: bool, is_present: bool) -> Any:
    """Send one request, about a row of the sample world and its present version or as it was drawn."""
    if is_there:
        point_to_rows(case, caller)
    sent = case.as_transport_kwargs(base_url="http://testserver")
    headers = {name: value for name, value in sent["headers"].items() if is_header(value)}
    headers |= {"Authorization": f"Bearer {caller.token}"}
    headers |= {"If-Match": "*"} if is_present else {}
    answer = send_request(caller.client, case, sent, headers)
    if answer.streaming:
        b"".join(answer.streaming_content)
    assert answer.status_code < 500, f"{case.as_curl_command()}\n{answer.content[:2000]!r}"
    return answer


def send_request(client: Client, case: Any, sent: dict[str, Any], headers: dict[str, str]) -> Any:
    """Send what was drawn, with the body as a client of HTTP writes it."""
    import requests

    options = {name: sent[name] for name in ("params", "json", "data", "files") if name in sent}
    prepared = requests.Request(case.method, sent["url"], headers=headers, **options).prepare()
    body = prepared.body or b""
    body = body.encode() if isinstance(body, str) else bytes(body)
    kind = prepared.headers.get("Content-Type", "application/json")
    return client.generic(case.method, prepared.path_url, body, kind, headers=headers)


def is_header(value: Any) -> bool:
    return isinstance(value, str) and value.isascii() and value.isprintable()


def point_to_rows(case: Any, caller: Caller) -> None:
    """Let the address lead to a row of the sample world."""
    values = {"world": caller.sample.world.name}
    try:
        name = resolve(numbered(case.path)).view_name
    except Resolver404:
        return
    keys = caller.keys[name](caller.sample) if name in caller.keys else {}
    values |= {NAMES_IN_THE_SCHEMA.get(each, each): value for each, value in keys.items()}
    known = {each: value for each, value in values.items() if f"{{{each}}}" in case.path}
    case.path_parameters = {**(case.path_parameters or {}), **known}
