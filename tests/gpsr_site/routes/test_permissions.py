"""Who may do what: each rule of the policy holds, and no route is without one."""

from __future__ import annotations

import pytest
from django.test import Client
from django.urls import reverse

from annotations.models import ApiToken, Scope
from tests.gpsr_site.routes.addresses import ALL_ROUTES, API_VIEWS, ROUTES_OF_ROWS, address
from tests.gpsr_site.routes.policy import (
    LOG_IN,
    NO,
    ONLY_POSTED,
    PEOPLE,
    POLICY,
    READ_AND_POSTED,
    YES,
)

REFUSED_METHODS = {
    *((name, "get") for name in ONLY_POSTED),
    *((name, "post") for name in ROUTES_OF_ROWS if name not in ONLY_POSTED | READ_AND_POSTED),
}


def test_every_route_has_a_rule():
    assert {rule.name for rule in POLICY} == set(ALL_ROUTES)


def test_every_method_of_the_api_has_a_rule():
    methods = {
        (name, method)
        for name, view in API_VIEWS.items()
        for method in ("get", "post", "put", "patch", "delete")
        if method in view.http_method_names and hasattr(view, method)
    }
    assert {(rule.name, rule.method) for rule in POLICY if rule.name in API_VIEWS} == methods


@pytest.mark.parametrize("person", PEOPLE)
@pytest.mark.parametrize("rule", POLICY, ids=str)
def test_the_policy_holds(rule, person, sample, client_as):
    answer = getattr(client_as(person), rule.method)(address(rule.name, sample))
    assert answer.status_code == getattr(rule, person)


@pytest.mark.parametrize("name", ROUTES_OF_ROWS)
@pytest.mark.parametrize("method", ["get", "post", "put", "patch", "delete"])
def test_an_id_of_another_world_is_not_found(name, method, sample, other_sample, client_as):
    answer = getattr(client_as("admin"), method)(address(name, sample, other_sample))
    assert answer.status_code in (404, 405)
    if method in ("get", "post") and answer.status_code == 405:
        assert (name, method) in REFUSED_METHODS


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
            assert client.post(address(rule.name, sample)).status_code == 403, rule


def test_accounts_are_the_business_of_superusers(superuser, admin, client):
    client.force_login(superuser)
    assert client.get(reverse("admin:index")).status_code == YES
    admin.is_staff = True
    admin.save()
    client.force_login(admin)
    assert client.get(reverse("admin:index")).status_code == LOG_IN


def test_a_token_that_reads_changes_nothing(sample, admin, client):
    _, key = ApiToken.issue(admin, "notebook", scope=Scope.READ)
    headers = {"authorization": f"Bearer {key}"}
    for rule in POLICY:
        view = API_VIEWS.get(rule.name)
        if view is None or view.__dict__.get("scopes", {}).get("POST") == Scope.READ:
            continue
        answer = getattr(client, rule.method)(address(rule.name, sample), headers=headers)
        assert answer.status_code == (YES if rule.method == "get" else NO), rule
