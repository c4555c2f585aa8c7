"""Who may do what: one line a route, and no route without a line."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import pytest
from django.test import Client
from django.urls import URLPattern, URLResolver, get_resolver, reverse

from tests.furnishing import House

PEOPLE = ("anonymous", "stranger", "annotator", "reviewer", "admin")
LOG_IN, NOWHERE, NO, YES, GONE_ON, WRONG = 302, 404, 403, 200, 302, 405


@dataclass(frozen=True)
class Rule:
    """What happens to each of ``PEOPLE`` who asks for ``name`` with ``method``.

    ``stranger`` has every duty, in another world.
    """

    name: str
    anonymous: int
    stranger: int
    annotator: int
    reviewer: int
    admin: int
    method: str = "get"

    def __str__(self) -> str:
        return f"{self.method} {self.name}"


MEMBERS = (LOG_IN, NOWHERE, YES, YES, YES)
ANNOTATORS = (LOG_IN, NOWHERE, YES, NO, YES)
ADMINS = (LOG_IN, NOWHERE, NO, NO, YES)

POLICY = [
    # Outside of any world
    Rule("healthz", YES, YES, YES, YES, YES),
    Rule("login", YES, GONE_ON, GONE_ON, GONE_ON, GONE_ON),
    Rule("logout", LOG_IN, GONE_ON, GONE_ON, GONE_ON, GONE_ON, method="post"),
    Rule("home", LOG_IN, YES, YES, YES, YES),
    Rule("banner", LOG_IN, YES, YES, YES, YES),
    Rule("admin:index", LOG_IN, LOG_IN, LOG_IN, LOG_IN, LOG_IN),
    Rule("world_new", LOG_IN, NO, NO, NO, NO),
    Rule("world_new", LOG_IN, NO, NO, NO, NO, method="post"),
    # What members look at
    *(
        Rule(name, *MEMBERS)
        for name in (
            "world",
            "ontology",
            "predicates",
            "grammar",
            "coverage",
            "templates",
            "template",
            "commands",
            "complexity",
            "forms",
            "form",
            "paraphrases",
            "splits",
            "split",
            "near_duplicates",
            "runs",
            "runs_table",
            "run",
            "run_state",
            "run_curves",
            "predictions",
            "prediction",
            "results",
            "results_table",
            "results_csv",
        )
    ),
    # What annotators write
    Rule("template_new", *ANNOTATORS),
    Rule("template", *ANNOTATORS, method="post"),
    Rule("template_new", *ANNOTATORS, method="post"),
    Rule("template_check", *ANNOTATORS, method="post"),
    Rule("template_preview", *ANNOTATORS, method="post"),
    Rule("generate", LOG_IN, NOWHERE, GONE_ON, NO, GONE_ON, method="post"),
    Rule("split_new", *ANNOTATORS),
    Rule("split_new", *ANNOTATORS, method="post"),
    # What admins decide
    Rule("import", *ADMINS),
    Rule("import_pairs", *ADMINS),
    Rule("run_new", *ADMINS),
    Rule("run_new", *ADMINS, method="post"),
    Rule("run_cancel", LOG_IN, NOWHERE, NO, NO, GONE_ON, method="post"),
    # What changes something is not done by following a link
    Rule("generate", LOG_IN, WRONG, WRONG, WRONG, WRONG),
    Rule("run_cancel", LOG_IN, WRONG, WRONG, WRONG, WRONG),
    Rule("template_check", LOG_IN, WRONG, WRONG, WRONG, WRONG),
    Rule("template_preview", LOG_IN, WRONG, WRONG, WRONG, WRONG),
    # The API (its own tests say more)
    Rule("api:schema", YES, YES, YES, YES, YES),
    Rule("api:split-export", 401, NOWHERE, YES, YES, YES),
]


def address(name: str, world: House, things: House | None = None) -> str:
    """The address of a route below ``world``, about ``things`` (of that world, unless given)."""
    things = things or world
    keys = {
        "template": {"pk": things.template.pk},
        "form": {"pk": things.form.pk},
        "split": {"pk": things.split.pk},
        "near_duplicates": {"pk": things.split.pk},
        "api:split-export": {"pk": things.split.pk},
        "prediction": {"pk": things.run.pk, "example": things.example.pk},
    }
    about_a_run = ("run", "run_state", "run_curves", "run_cancel", "predictions")
    found = {"pk": things.run.pk} if name in about_a_run else keys.get(name, {})
    if name in ROUTES_OF_WORLDS:
        found["world"] = world.world.name
    return reverse(name, kwargs=found) + ("?as=jsonl" if name == "api:split-export" else "")


def routes(patterns, namespace: str = "", path: str = "") -> Iterator[tuple[str, str]]:
    """Name and path of every route; what Django's own admin adds counts as ``admin:index``."""
    for pattern in patterns:
        here = path + str(pattern.pattern)
        if isinstance(pattern, URLResolver):
            inside = f"{pattern.namespace}:" if pattern.namespace else namespace
            if pattern.namespace == "admin":
                yield "admin:index", here
            else:
                yield from routes(pattern.url_patterns, inside, here)
        elif isinstance(pattern, URLPattern):
            yield f"{namespace}{pattern.name}", here


ALL_ROUTES = dict(routes(get_resolver().url_patterns))
ROUTES_OF_WORLDS = {name for name, path in ALL_ROUTES.items() if "<slug:world>" in path}
ROUTES_OF_THINGS = sorted(name for name in ROUTES_OF_WORLDS if "<int:" in ALL_ROUTES[name])


def test_every_route_has_a_rule():
    assert {rule.name for rule in POLICY} == set(ALL_ROUTES)


@pytest.mark.parametrize("person", PEOPLE)
@pytest.mark.parametrize("rule", POLICY, ids=str)
def test_the_policy_holds(rule, person, house, request, client):
    if person != "anonymous":
        client.force_login(request.getfixturevalue(person))
    answer = getattr(client, rule.method)(address(rule.name, house))
    assert answer.status_code == getattr(rule, person)


@pytest.mark.parametrize("name", ROUTES_OF_THINGS)
@pytest.mark.parametrize("method", ["get", "post", "put", "patch", "delete"])
def test_an_id_of_another_world_is_not_found(name, method, house, other_house, admin, client):
    client.force_login(admin)
    answer = getattr(client, method)(address(name, house, other_house))
    assert answer.status_code in (404, 405)
    if method in ("get", "post") and answer.status_code == 405:
        assert (name, method) in {
            ("run_cancel", "get"),
            *(
                (each, "post")
                for each in ROUTES_OF_THINGS
                if each not in ("template", "run_cancel")
            ),
        }


def test_who_may_not_is_told_in_a_sentence(house, annotator, client):
    client.force_login(annotator)
    answer = client.get(address("run_new", house))
    assert "Only admins of this world may do this. Ask an admin of home" in answer.content.decode()


def test_an_account_that_is_switched_off_is_nobody(house, annotator, client):
    client.force_login(annotator)
    annotator.is_active = False
    annotator.save()
    assert client.get(address("world", house)).status_code == LOG_IN


def test_what_changes_something_needs_a_token_of_the_page(house, admin):
    client = Client(enforce_csrf_checks=True)
    client.force_login(admin)
    for rule in POLICY:
        if rule.method == "post":
            assert client.post(address(rule.name, house)).status_code == 403, rule


def test_accounts_are_the_business_of_superusers(superuser, admin, client):
    client.force_login(superuser)
    assert client.get(reverse("admin:index")).status_code == YES
    admin.is_staff = True
    admin.save()
    client.force_login(admin)
    assert client.get(reverse("admin:index")).status_code == LOG_IN
