"""Whatever page or route a text comes by, it is stored in one normal form.

Routes, forms and fields are asked of the site itself, so that a new one is tried too.
"""

from __future__ import annotations

import json
import unicodedata
from collections import Counter
from collections.abc import Iterator

import pytest
from django.apps import apps
from django.db import models, transaction

from annotations.web.rest.parsing import BoundedJSONParser, FilesParser
from parser_service.web.serving.parsing_rest import JsonLinesParser
from tests.gpsr_site.routes.addresses import address
from tests.gpsr_site.routes.bodies import bodies, example_of
from tests.gpsr_site.routes.listing import API_ROUTES
from tests.gpsr_site.routes.policy import POLICY
from tests.gpsr_site.routes.rules import undone
from tests.gpsr_site.routes.test_odd_input import FIELDS_ELSEWHERE, FORM, fields_of, in_query
from tests.sample_world import SampleWorld

INVISIBLE = "\u200b\u202e\xad"
DECOMPOSED = "e\u0301"
# A log-in begins with another session, and a password is kept as it was typed.
OTHER_PAGES = {"login", "logout", "join", "password", "password_set", "sessions_end", "session_end"}
PAGES = sorted(
    {rule.name for rule in POLICY if rule.method == "post" and not rule.name.startswith("api:")}
    - OTHER_PAGES
)


def odd(text: str) -> str:
    """Return a text that looks as ``text`` does."""
    return f"{INVISIBLE}{text}{INVISIBLE}"


def texts_in(value: object) -> Iterator[str]:
    match value:
        case str():
            yield value
        case dict():
            for name, each in value.items():
                yield from (name, *texts_in(each))
        case list() | tuple():
            for each in value:
                yield from texts_in(each)


def assert_all_is_normal() -> None:
    """Look at each text and each JSON value of the whole database."""
    for model in apps.get_models():
        columns = [
            field.name
            for field in model._meta.concrete_fields
            if isinstance(field, models.CharField | models.TextField | models.JSONField)
        ]
        for row in model._default_manager.values_list(*columns) if columns else ():
            for name, value in zip(columns, row, strict=True):
                for text in texts_in(value):
                    place = f"{model.__name__}.{name}: {text[:80]!r}"
                    assert not set(INVISIBLE) & set(text), place
                    assert unicodedata.is_normalized("NFC", text), place


@pytest.fixture
def no_wake_up(monkeypatch) -> None:
    monkeypatch.setattr("annotations.background.waking.send_wake_up", lambda queue: None)


@pytest.fixture
def root(client_as, no_wake_up):
    return client_as("superuser")


def test_a_form_stores_nothing_invisible(sample: SampleWorld, client_as, no_wake_up, subtests):
    for name in PAGES:
        with subtests.test(name), undone():
            post_invisible(name, address(name, sample), client_as("superuser"))


def post_invisible(name: str, path: str, root) -> None:
    usual = fields_of(root, path) or dict.fromkeys(FIELDS_ELSEWHERE.get(name, ()), "")
    sent = {key: str(each) for key, each in usual.items() if isinstance(each, str | int | float)}
    for free in ("", DECOMPOSED, f"go to the caf{DECOMPOSED}"):
        # What is there already passes the checks of the form; what is empty is filled.
        body = {key: odd(value or free) for key, value in sent.items()}
        answer = root.post(path, in_query(body), FORM)
        assert answer.status_code < 500
    for key in sent:
        answer = root.post(path, in_query({**sent, key: odd(DECOMPOSED)}), FORM)
        assert answer.status_code < 500
    assert_all_is_normal()


@pytest.mark.parametrize("free", [f"caf{DECOMPOSED}", f"go to the caf{DECOMPOSED}", "2030-01-01"])
def test_a_body_stores_nothing_invisible(free, sample: SampleWorld, root):
    statuses = Counter()
    for body in bodies():
        sent = {odd(name): example_of(each, odd, free) for name, each in body.fields.items()}
        for names in (sent, *({name: sent[name]} for name in sent)):
            with transaction.atomic():  # the next request finds the rows that this one deletes
                answer = getattr(root, body.method)(
                    address(body.route, sample),
                    json.dumps(names),
                    "application/json",
                    headers={"if-match": "*"},
                )
                statuses[answer.status_code] += 1
                assert answer.status_code in (503, *range(500)), (body, answer.content)
                if answer.status_code < 300:
                    assert_all_is_normal()
                transaction.set_rollback(True)
    assert sum(statuses[status] for status in (200, 201, 202, 204)) > 10, statuses


def test_every_route_reads_bodies_in_the_one_way():
    readers = (
        BoundedJSONParser,
        FilesParser,
        JsonLinesParser,
    )  # of JSON lines one for each name of theirs
    for name, route in API_ROUTES.items():
        assert all(issubclass(each, readers) for each in route.view.parser_classes), name
