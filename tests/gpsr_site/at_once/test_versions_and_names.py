"""Twenty people at the same moment, on the real database: one of them is first, and the others are told.

Which routes change a version (``If-Match``) and which are posted to is asked of the site itself.
"""

from __future__ import annotations

import json
from collections import Counter
from functools import partial
from typing import Any

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile
from django.db import connection
from django.test import Client
from django.urls import reverse

from annotations.models import (
    ApiToken,
    Campaign,
    Editable,
    Entity,
    EntityClass,
    Membership,
    Primitive,
    Recipe,
    Split,
    TaskCategory,
    User,
    World,
)
from annotations.models.worlds import Role
from parser_service.models import ErrorCategory, Slice
from tests.at_once import at_once
from tests.conftest import client_of
from tests.gpsr_site.at_once.writes import (
    CHANGES,
    NAMELESS,
    NAMES,
    SHOWN_BY,
    keys_for,
    small_archive,
)
from tests.gpsr_site.routes import addresses
from tests.gpsr_site.routes.addresses import address
from tests.gpsr_site.routes.listing import API_ROUTES
from tests.sample_world import SampleWorld, fill_world

WRITERS, ROUNDS = 20, 3
TOO_LATE, GONE = 412, 404


@pytest.fixture
def sample(transactional_db, world, monkeypatch) -> SampleWorld:
    # The broker's part begins after the row is stored, and is not what is raced for here.
    monkeypatch.setattr("annotations.background.waking.send_wake_up", lambda queue: None)
    return fill_world(world)


@pytest.fixture
def key(transactional_db, superuser) -> str:
    return ApiToken.issue(superuser, "robot")[1]


def send(key: str, method: str, path: str, body: Any = None, **headers: str) -> Any:
    caller = Client(raise_request_exception=False)
    headers["authorization"] = f"Bearer {key}"
    sent = json.dumps(body) if body is not None else ""
    return caller.generic(method, path, sent, "application/json", headers=headers)


def test_every_route_that_changes_a_version_is_raced_for():
    conditional = {
        (name, method)
        for name, route in API_ROUTES.items()
        for method in map(str.upper, route.methods)
        if route.asked(method) in getattr(route.view, "conditional", ())
    }
    assert conditional == set(CHANGES)


def test_whatever_is_changed_or_deleted_asks_for_a_version():
    asked = {
        (name, method.upper())
        for name, route in API_ROUTES.items()
        for method in route.methods & {"put", "patch", "delete"}
    }
    assert asked <= set(CHANGES)


@pytest.mark.parametrize("route", CHANGES, ids=" ".join)
def test_of_many_writers_of_one_version_one_wins(route, sample, superuser, key, monkeypatch):
    name, method = route
    monkeypatch.setattr(addresses, "KEYS", keys_for(superuser, sample))
    path = address(name, sample)
    shown_at = address(SHOWN_BY.get(name, name), sample)
    winners = []
    for turn in range(1 if method == "DELETE" else ROUNDS):
        before = send(key, "GET", shown_at)
        bodies = [CHANGES[route](writer, turn) for writer in range(WRITERS)]
        writers = [
            partial(send, key, method, path, body, if_match=before["ETag"]) for body in bodies
        ]
        answers = at_once(*writers)
        statuses = Counter(answer.status_code for answer in answers)
        first = [answer for answer in answers if answer.status_code < 300]
        winners.append(len(first))
        allowed = {TOO_LATE, GONE} if method == "DELETE" else {TOO_LATE}
        assert {each for each in statuses if each >= 300} <= allowed, answers[0].text
        after = send(key, "GET", shown_at)
        if method == "DELETE":
            assert after.status_code == GONE
            continue
        require_stored(first[0].json(), after)
        assert after["ETag"] != before["ETag"]
        if "version" in before.json():
            assert after.json()["version"] == before.json()["version"] + 1
        require_history(name, after.json())
    print(f"{connection.vendor} {name} {method}: {winners}")
    assert winners == [1] * len(winners)


def require_stored(answer: dict[str, Any], after: Any) -> None:
    """The row is as the winner was told."""
    told = answer.get("row", answer)
    stored = after.json()
    assert {name: told[name] for name in stored} == stored


def require_history(name: str, shown: dict[str, Any]) -> None:
    """The history of a row that has one keeps this version once."""
    model = getattr(API_ROUTES[SHOWN_BY.get(name, name)].view, "model", None)
    if model and issubclass(model, Editable):
        entries = model.history.filter(id=shown["id"], version=shown["version"])
        assert entries.count() == 1


def test_every_route_that_is_posted_to_is_known():
    posted = {name for name, route in API_ROUTES.items() if "post" in route.methods}
    assert posted == set(NAMES) | {f"api:{name}" for name in NAMELESS}


MADE = {
    "api:entity-list": lambda: Entity.objects.filter(text="flurb"),
    "api:entity-class-list": lambda: EntityClass.objects.filter(token="garment"),
    "api:predicate-list": lambda: World.objects.get(name="home").predicates.filter(name="shines"),
    "api:task-category-list": lambda: TaskCategory.objects.filter(name="baking"),
    "api:recipe-list": lambda: Recipe.objects.filter(action="dance"),
    "api:primitive-list": lambda: Primitive.objects.filter(name="dance"),
    "api:worlds": lambda: World.objects.filter(name="attic"),
    "api:import-world": lambda: World.objects.exclude(name__in=["home", "cellar"]),
    "api:split-list": lambda: Split.objects.filter(name="mine"),
    "api:campaign-list": lambda: Campaign.objects.filter(name="spring"),
    "api:slice-list": lambda: Slice.objects.filter(name="wrong ones"),
    "api:error-category-list": lambda: ErrorCategory.objects.filter(name="Slip"),
    "api:member-list": lambda: Membership.objects.filter(
        user__username="someone in home", role=Role.ANNOTATOR
    ),
}


@pytest.mark.parametrize("name", NAMES)
def test_of_many_equal_rows_one_is_made(name, sample, key):
    User.objects.create_user("someone in home")
    path, body = address(name, sample), NAMES[name]
    if name == "api:import-world":
        ask = partial(send_file, key, path, body, small_archive())
    else:
        ask = partial(send, key, "POST", path, body)
    answers = at_once(*[ask] * WRITERS)
    statuses = Counter(answer.status_code for answer in answers)
    assert statuses[200] + statuses[201] == 1, answers[0].text
    assert set(statuses) <= {200, 201, 400, 409}, statuses
    refusals = [answer.json() for answer in answers if answer.status_code >= 400]
    assert all(refusal["detail"] for refusal in refusals)
    assert MADE[name]().count() == 1


def send_file(key: str, path: str, body: dict[str, Any], archive: bytes) -> Any:
    caller = Client(raise_request_exception=False)
    file = SimpleUploadedFile("home.zip", archive)
    headers = {"authorization": f"Bearer {key}"}
    return caller.post(path, {**body, "archive": file}, headers=headers)


PAGES = {
    "entity_new": {**NAMES["api:entity-list"], "aliases": "", "attributes": ""},
    "entities_new": {"entity_class": "object", "lines": "flurb", "attributes": "", "add": "yes"},
    "entity_class_new": NAMES["api:entity-class-list"],
    "task_category_new": NAMES["api:task-category-list"],
    "recipe_new": NAMES["api:recipe-list"],
    "primitive_new": NAMES["api:primitive-list"],
    "predicate_new": {**NAMES["api:predicate-list"], "signatures": "(object)", "gloss": ""},
    "world_new": {"name": "attic", "description": ""},
    "slices": {**NAMES["api:slice-list"], "chosen": "outcome=wrong"},
    "error_categories": {**NAMES["api:error-category-list"], "slice": ""},
    "split_new": {
        **{"name": "mine", "criterion": "command", "seed": "0"},
        **{"train": "70", "validation": "10", "test": "20", "freeze": "yes"},
    },
    "campaign_new": {
        **{"name": "spring", "wording": "command", "target_per_form": "10", "seed": "0"},
        **{"balance": "forms"},
        **{"prompts_per_form": "1", "task_size": "2", "free_commands": "0", "check_every": "0"},
        **{"taboo_words": "0", "most_per_hour": "9", "launch": "yes"},
    },
    "people": NAMES["api:member-list"],
}
# The page that makes what a route of the API makes.
ROUTE_OF_PAGE = {
    "entity_new": "api:entity-list",
    "entities_new": "api:entity-list",
    "entity_class_new": "api:entity-class-list",
    "task_category_new": "api:task-category-list",
    "recipe_new": "api:recipe-list",
    "primitive_new": "api:primitive-list",
    "predicate_new": "api:predicate-list",
    "world_new": "api:worlds",
    "slices": "api:slice-list",
    "error_categories": "api:error-category-list",
    "split_new": "api:split-list",
    "campaign_new": "api:campaign-list",
    "people": "api:member-list",
}


@pytest.mark.parametrize("name", PAGES)
def test_of_many_equal_forms_one_row_is_made(name, sample, superuser):
    User.objects.create_user("someone in home")
    path = reverse(name, kwargs={} if name == "world_new" else {"world": "home"})
    clients = [client_of(superuser) for _ in range(WRITERS)]
    for client in clients:
        client.raise_request_exception = False
    answers = at_once(*(partial(client.post, path, PAGES[name]) for client in clients))
    statuses = Counter(answer.status_code for answer in answers)
    assert max(statuses) < 500, statuses
    assert MADE[ROUTE_OF_PAGE[name]]().count() == 1
