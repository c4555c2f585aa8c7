"""Who may do what: each rule of the policy holds, and no route and no method is without one.

Which routes there are, and which methods each takes, is asked of the site itself.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator
from itertools import product

import pytest
from django.test import Client
from django.urls import reverse

from annotations.models import ApiToken, Scope
from tests.gpsr_site.routes.addresses import address
from tests.gpsr_site.routes.listing import ALL_ROUTES, API_ROUTES, ROUTES_OF_ROWS
from tests.gpsr_site.routes.policy import LOG_IN, NO, NOWHERE, PEOPLE, POLICY, YES
from tests.gpsr_site.routes.rules import WRONG, undone

METHODS = ("get", "head", "post", "put", "patch", "delete")
NO_TOKEN = 401
PAGES = sorted(ALL_ROUTES.keys() - API_ROUTES.keys() - {"admin:index"})
ADMIN_OF_DJANGO = {"admin:index"}  # has views of its own below it
# What each route takes, by the rules; HEAD is GET without the body.
TAKEN = {name: {rule.method for rule in POLICY if rule.name == name} for name in ALL_ROUTES}
TAKEN = {name: each | ({"head"} if "get" in each else set()) for name, each in TAKEN.items()}
# What happens to each person who asks for a route with a method that it takes.
OUTCOMES = {
    (rule.name, rule.method, person): getattr(rule, person) for rule in POLICY for person in PEOPLE
}


@pytest.fixture(autouse=True)
def silence() -> Iterator[None]:
    """Write no lines about refused requests: thousands of tracebacks would cost more than the requests."""
    logging.disable(logging.ERROR)
    yield
    logging.disable(logging.NOTSET)


def status(client: Client, method: str, path: str) -> int:
    with undone():
        return int(getattr(client, method)(path).status_code)


def test_every_route_has_a_rule():
    assert {rule.name for rule in POLICY} == set(ALL_ROUTES)


def test_every_method_of_the_api_has_a_rule():
    for name, route in API_ROUTES.items():
        assert TAKEN[name] - {"head"} == route.methods & set(METHODS), name


def test_every_method_of_a_page_has_a_rule(sample, client_as, subtests):
    """A page that is asked with a method that no page knows says which ones it takes."""
    for name in PAGES:
        is_open = all(rule.anonymous != LOG_IN for rule in POLICY if rule.name == name)
        client = client_as("anonymous" if is_open else "superuser")
        with subtests.test(name), undone():
            answer = client.generic("BREW", address(name, sample))
            assert answer.status_code == WRONG
            taken = {method.strip().lower() for method in answer["Allow"].split(",")}
            assert taken - {"options"} == TAKEN[name]


def test_the_policy_holds(sample, client_as, subtests):
    for rule, person in product(POLICY, PEOPLE):
        path = address(rule.name, sample)
        let_in = [each for each in PEOPLE if getattr(rule, each) == YES]
        methods = [rule.method]
        # HEAD is GET without the body: whom this refuses that refuses, and it lets in as well.
        if rule.method == "get" and person not in let_in[1:]:
            methods.append("head")
        for method in methods:
            with subtests.test(rule.name, method=method, person=person):
                assert status(client_as(person), method, path) == getattr(rule, person)


@pytest.mark.parametrize("person", ["anonymous", "superuser"])
def test_no_other_method_does_anything(person, sample, client_as):
    """Not even for somebody who may do everything."""
    client = client_as(person)
    refusals = {WRONG, LOG_IN, NO_TOKEN} if person == "anonymous" else {WRONG}
    for name in sorted(ALL_ROUTES.keys() - ADMIN_OF_DJANGO):
        path = address(name, sample)
        for method in (each for each in METHODS if each not in TAKEN[name]):
            assert getattr(client, method)(path).status_code in refusals, f"{method} {name}"


def test_an_id_of_another_world_is_not_found(sample, other_sample, client_as, subtests):
    for name, person in product(ROUTES_OF_ROWS, PEOPLE):
        path, client = address(name, sample, other_sample), client_as(person)
        for method in sorted(TAKEN[name] - {"head"}):
            usual = OUTCOMES[name, method, person]
            # Some look at the role before they look for the row.
            wanted = {NO, NOWHERE} if usual == NO else {NOWHERE}
            with subtests.test(name, method=method, person=person):
                got = status(client, method, path)
                assert got in ({usual} if person == "anonymous" else wanted)


def test_an_account_that_is_switched_off_is_nobody(sample, annotator, client):
    client.force_login(annotator)
    annotator.is_active = False
    annotator.save()
    assert client.get(address("world", sample)).status_code == LOG_IN


def test_what_changes_something_needs_a_token_of_the_page(sample, admin):
    client = Client(enforce_csrf_checks=True)
    client.force_login(admin)
    for rule in POLICY:
        if rule.method == "post":
            assert client.post(address(rule.name, sample)).status_code == NO, rule


def test_accounts_are_the_business_of_superusers(superuser, admin, client):
    client.force_login(superuser)
    assert client.get(reverse("admin:index")).status_code == YES
    admin.is_staff = True
    admin.save()
    client.force_login(admin)
    assert client.get(reverse("admin:index")).status_code == LOG_IN


def test_a_token_that_reads_changes_nothing(sample, admin):
    _, key = ApiToken.issue(admin, "notebook", scope=Scope.READ)
    headers = {"authorization": f"Bearer {key}"}
    for rule in POLICY:
        route = API_ROUTES.get(rule.name)
        if route is None:
            continue
        scope = getattr(route.view, "scopes", {}).get(route.asked(rule.method))
        if rule.method == "post" and scope == Scope.READ:
            continue
        client = Client()  # another one keeps the threads of its downloads
        answer = getattr(client, rule.method)(address(rule.name, sample), headers=headers)
        assert answer.status_code == (rule.admin if rule.method == "get" else NO), rule
