"""The card that says what answers here, and the same over REST: /api/v1/worlds/<w>/answerer/"""

from __future__ import annotations

import re

import pytest

from annotations.models import AuditEntry
from parser_service.models.answering import answering_of
from parser_service.runs.promoting import promote
from parser_service.serving.answering import choose_answering
from tests.annotations.conftest import import_tiny
from tests.notices import levels
from tests.parser_service.llm_server import MODEL, installed_tiny_server
from tests.parser_service.made_up import make_split
from tests.parser_service.served import trained_run

PAGE, API = "/w/home/promotion/", "worlds/home/answerer/"


@pytest.fixture
def run(world):
    import_tiny(world)
    run = trained_run(make_split(world))
    promote(run, None)
    return run


def chosen(world):
    row = answering_of(world)
    return row.order, row.allowed_wrong


def test_everybody_sees_what_answers_and_admins_choose_it(run, anna, adam):
    for browser, may in ((anna, False), (adam, True)):
        page = browser.get(PAGE)
        assert page.context["parts"].titles[1].startswith(f"run {run.pk},")
        assert (f'action="{PAGE}answering/"' in page.content.decode()) is may
    assert anna.post(f"{PAGE}answering/", {"order": "oracle"}).status_code == 403


def test_an_admin_chooses_and_undoes_it(run, adam, world):
    sent = {"order": "oracle", "allowed_percent": "5", "version": 0}
    page = adam.post(f"{PAGE}answering/", sent, follow=True)
    assert levels(page) == ["success"] and chosen(world) == ("oracle", 0.05)
    assert page.context["parts"].run is None
    assert AuditEntry.objects.latest("pk").what == "choose what answers"
    (message,) = page.context["messages"]
    undo = dict(re.findall(r'name="(\w+)" value="([^"]*)"', str(message)))
    adam.post(f"{PAGE}answering/", undo)
    assert chosen(world) == ("both", 0.02)


@pytest.mark.parametrize(
    "sent",
    [
        {"allowed_percent": ""},
        {"allowed_percent": "many"},
        {"allowed_percent": "51"},
        {"allowed_percent": "nan"},
        {"order": "neither"},
        {"version": 7},
    ],
)
def test_what_cannot_be_is_a_sentence(run, adam, world, sent):
    whole = {"order": "oracle", "allowed_percent": "5", "version": 0, **sent}
    page = adam.post(f"{PAGE}answering/", whole, follow=True)
    assert levels(page) == ["error"] and chosen(world) == ("both", 0.02)


def test_the_state_says_that_no_learned_part_is_asked(run, anna, admin, world):
    choose_answering(world, "oracle", 0.02, admin, 0)
    state = anna.get("/w/home/parse/state/")
    assert state.context["parts"].has_oracle and state.context["parts"].run is None


def test_the_route_shows_the_parts_and_what_an_answer_needs(run, call_as, annotator):
    shown = call_as(annotator, "get", API).json()
    assert shown["parts"] == [
        {"parser": "grammar-oracle", "run": None},
        {"parser": "knn", "run": run.pk},
    ]
    assert (shown["order"], shown["allowed_wrong"], shown["version"]) == ("both", 0.02, 0)
    assert shown["calibrated_on"] == 0 and shown["operating_point"]["act"] == 0.98


def test_the_route_changes_what_was_read(run, call_as, admin, world):
    tag = call_as(admin, "get", API)["ETag"]
    changed = call_as(admin, "patch", API, {"order": "learned"}, if_match=tag)
    assert changed.status_code == 200 and changed["ETag"] != tag
    assert changed.json()["parts"] == [{"parser": "knn", "run": run.pk}]
    assert chosen(world) == ("learned", 0.02)
    late = call_as(admin, "patch", API, {"allowed_wrong": 0.2}, if_match=tag)
    assert late.status_code == 412 and chosen(world) == ("learned", 0.02)
    assert call_as(admin, "patch", API, {"allowed_wrong": 0.2}).status_code == 428
    now = changed["ETag"]
    assert call_as(admin, "patch", API, {"allowed_wrong": 0.9}, if_match=now).status_code == 400
    assert call_as(admin, "patch", API, {"allowed_wrong": 0.2}, if_match=now).status_code == 200
    assert chosen(world) == ("learned", 0.2)


@pytest.fixture
def tiny(tmp_path):
    with installed_tiny_server(tmp_path) as server:
        yield server


@pytest.fixture
def model_run(run, tiny):
    return trained_run(
        make_split(run.world, "model"), parser="llm", config={"model": MODEL}, protocol="domain"
    )


def test_a_language_model_is_switched_on_and_off_on_the_page(model_run, adam, world):
    assert adam.get(PAGE).context["last_problem"] == ""
    sent = {"order": "both", "allowed_percent": "2", "version": 0, "asks_language_model": "on"}
    page = adam.post(f"{PAGE}answering/", sent, follow=True)
    assert levels(page) == ["success"] and page.context["parts"].last == model_run
    assert f"{MODEL} at 127.0.0.1" in page.content.decode()
    (message,) = page.context["messages"]
    undo = dict(re.findall(r'name="(\w+)" value="([^"]*)"', str(message)))
    adam.post(f"{PAGE}answering/", undo)
    assert not answering_of(world).asks_language_model


def test_the_page_says_why_no_language_model_can_be_asked(run, adam):
    page = adam.get(PAGE)
    assert page.context["last_problem"] and 'name="asks_language_model"' not in str(page.content)
    sent = {"order": "both", "allowed_percent": "2", "version": 0, "asks_language_model": "on"}
    assert levels(adam.post(f"{PAGE}answering/", sent, follow=True)) == ["error"]


def test_the_route_switches_the_language_model(model_run, call_as, admin):
    shown = call_as(admin, "get", API)
    assert shown.json()["asks_language_model"] is False
    sent = {"asks_language_model": True}
    changed = call_as(admin, "patch", API, sent, if_match=shown["ETag"]).json()
    assert changed["asks_language_model"] is True and changed["order"] == "both"
    assert changed["parts"][-1] == {"parser": "llm", "run": model_run.pk}


def test_the_route_refuses_a_language_model_that_cannot_be_asked(run, call_as, admin, world):
    tag = call_as(admin, "get", API)["ETag"]
    refused = call_as(admin, "patch", API, {"asks_language_model": True}, if_match=tag)
    assert refused.status_code == 409
    assert not answering_of(world).asks_language_model
