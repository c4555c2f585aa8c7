"""Logging in: where it leads, and how often one may get it wrong."""

from __future__ import annotations

import re
import threading
from ipaddress import ip_network
from itertools import cycle, islice
from types import SimpleNamespace

import pytest

from annotations.models import User
from annotations.people.members import add_roles
from gpsr_site.accounts import password_pages
from gpsr_site.accounts.password_pages import BY_ADDRESS, BY_NAME, BY_NAME_AND_ADDRESS, TOO_OFTEN
from tests.waiting import PATIENCE_SECONDS

RIGHT = {"username": "anna", "password": "correct horse"}
WRONG = {**RIGHT, "password": "wrong"}
LIMIT = BY_NAME_AND_ADDRESS.limit


@pytest.fixture(autouse=True)
def _people(annotator):
    """Somebody who can log in."""


def fail(client, times, **extra):
    for _ in range(times):
        answer = client.post("/login/", WRONG, **extra)
    return answer


def test_the_right_password_leads_to_the_page_that_was_asked_for(client):
    asked = client.get("/w/home/commands/")
    assert asked.url == "/login/?next=/w/home/commands/"
    answer = client.post("/login/", {**RIGHT, "next": "/w/home/commands/"})
    assert answer.url == "/w/home/commands/"


@pytest.mark.parametrize(("asked", "is_told"), [("/", False), ("/w/home/commands/", True)])
def test_only_who_asked_for_a_page_is_told_to_go_on_to_it(asked, is_told, client):
    page = client.get("/login/", {"next": asked}).content.decode()
    assert ("to continue" in page) is is_told


def test_the_focus_is_where_one_goes_on(client):
    def focused(answer):
        return re.search(r'<input\s[^>]*name="(\w+)"[^>]*autofocus', answer.content.decode())[1]

    assert focused(client.get("/login/")) == "username"
    assert focused(client.post("/login/", WRONG)) == "password"


def test_what_the_field_is_called_the_error_calls_it_too(client):
    page = client.post("/login/", WRONG).content.decode()
    assert ">Username</label>" in page and "has this username and" in page


@pytest.mark.parametrize(
    "elsewhere",
    ["https://elsewhere.example/", "//elsewhere.example", "/\\elsewhere.example", "javascript:a"],
)
def test_one_is_not_led_to_another_site(elsewhere, client):
    answer = client.post("/login/", {**RIGHT, "next": elsewhere})
    assert answer.url == "/w/home/"


def test_a_wrong_password_is_told_on_the_page(client):
    answer = client.post("/login/", WRONG)
    assert answer.status_code == 200
    assert answer.context["form"].has_error("__all__", "invalid_login")


def test_after_too_many_failures_even_the_right_password_waits(client):
    assert fail(client, LIMIT).status_code == 200
    answer = client.post("/login/", RIGHT)
    assert answer.status_code == 429
    assert answer["Retry-After"] == "600"
    assert TOO_OFTEN in answer.content.decode()


@pytest.mark.parametrize("name", [" ANNA ", "ａｎｎａ", "Anna\u2003"])
def test_spelling_the_name_otherwise_does_not_help(name, client):
    fail(client, LIMIT)
    assert client.post("/login/", {**RIGHT, "username": name}).status_code == 429


def test_django_s_admin_has_no_door_of_its_own(superuser, client):
    answer = client.post("/admin/login/", {"username": "root", "password": "correct horse"})
    assert answer.url == "/login/?next=/admin/"
    assert client.get("/admin/").url == "/admin/login/?next=/admin/"
    assert client.get("/admin/login/?next=/admin/").url == "/login/?next=/admin/"


def test_whoever_may_not_enter_the_admin_is_told_rather_than_led_in_circles(annotator, client):
    client.force_login(annotator)
    assert client.get("/admin/", follow=True).status_code == 403


def test_somebody_elsewhere_is_not_locked_out(client):
    fail(client, LIMIT)
    assert client.post("/login/", RIGHT, REMOTE_ADDR="192.0.2.7").status_code == 302


def test_behind_a_trusted_proxy_clients_are_told_apart(client, settings):
    settings.TRUSTED_PROXIES = [ip_network("127.0.0.1")]
    fail(client, LIMIT, HTTP_X_FORWARDED_FOR="203.0.113.9")
    again = client.post("/login/", RIGHT, HTTP_X_FORWARDED_FOR="203.0.113.9")
    elsewhere = client.post("/login/", RIGHT, HTTP_X_FORWARDED_FOR="192.0.2.7")
    assert (again.status_code, elsewhere.status_code) == (429, 302)


def test_a_made_up_address_does_not_help(client):
    for number in range(LIMIT):
        client.post("/login/", WRONG, HTTP_X_FORWARDED_FOR=f"192.0.2.{number}")
    assert client.post("/login/", RIGHT, HTTP_X_FORWARDED_FOR="192.0.2.99").status_code == 429


def test_one_address_cannot_try_many_names(client):
    for number in range(BY_ADDRESS.limit):
        client.post("/login/", {"username": f"name{number}", "password": "guess"})
    assert client.post("/login/", RIGHT).status_code == 429


def test_a_class_behind_one_address_logs_in(client):
    names = [f"pupil{number}" for number in range(1 + BY_ADDRESS.limit // (BY_NAME.limit // 2))]
    for name in names:
        User.objects.create_user(name, password=RIGHT["password"])
    for name in islice(cycle(names), BY_ADDRESS.limit + 1):
        assert client.post("/login/", {**RIGHT, "username": name}).status_code == 302
        client.post("/logout/")


def test_a_name_that_the_world_tries_is_slow_and_not_locked(client, monkeypatch):
    waited = []
    monkeypatch.setattr(password_pages, "time", SimpleNamespace(sleep=waited.append))
    while BY_NAME.take("anna"):
        pass
    assert client.post("/login/", RIGHT).status_code == 302
    assert waited == [password_pages.SLOW_SECONDS]


def test_slow_attempts_never_hold_all_threads(client, monkeypatch):
    everybody_waits, over = threading.Barrier(3), threading.Event()

    def sleep(seconds):
        if not over.is_set():
            everybody_waits.wait(PATIENCE_SECONDS)
            over.wait(PATIENCE_SECONDS)

    monkeypatch.setattr(password_pages, "time", SimpleNamespace(sleep=sleep))
    while BY_NAME.take("anna"):
        pass
    waiting = [threading.Thread(target=password_pages.wait_slowly) for _ in range(2)]
    for thread in waiting:
        thread.start()
    everybody_waits.wait(PATIENCE_SECONDS)
    assert client.post("/login/", RIGHT).status_code == 429
    over.set()
    for thread in waiting:
        thread.join()
    assert client.post("/login/", RIGHT).status_code == 302


def test_the_limit_survives_many_other_names(client):
    fail(client, LIMIT)
    for number in range(400):
        BY_NAME_AND_ADDRESS.take(f"192.0.2.1 somebody{number}")
    assert client.post("/login/", RIGHT).status_code == 429


def test_a_success_forgets_the_failures(client):
    fail(client, LIMIT - 1)
    assert client.post("/login/", RIGHT).status_code == 302
    client.post("/logout/")
    assert fail(client, LIMIT - 1).status_code == 200


def test_a_password_of_a_megabyte_is_not_hashed(client, monkeypatch):
    monkeypatch.setattr("django.contrib.auth.authenticate", lambda *a, **k: pytest.fail("hashed"))
    answer = client.post("/login/", {**RIGHT, "password": "a" * 50_000})
    assert "at most 1000 characters" in answer.content.decode()


def test_logging_out_takes_a_post(client, annotator):
    client.force_login(annotator)
    assert client.get("/logout/").status_code == 405
    assert client.post("/logout/").url == "/login/"
    assert client.get("/").status_code == 302


def test_whoever_has_one_world_lands_in_it(annotator, world, other_world, client):
    assert client.post("/login/", {**RIGHT, "next": "/"}).url == f"/w/{world.name}/"
    client.logout()
    add_roles(other_world, annotator, ["annotator"])
    assert client.post("/login/", RIGHT).url == "/"


def test_nobody_asked_for_the_list_of_worlds(annotator, client):
    assert client.get("/login/?next=/").context["next"] == ""
    assert client.get("/login/?next=/w/home/commands/").context["next"] == "/w/home/commands/"


def test_after_a_wrong_password_the_cursor_stands_in_its_field(annotator, client):
    page = client.post("/login/", WRONG).content.decode()
    assert re.findall(r"<input[^>]*autofocus", page) == re.findall(
        r'<input[^>]*type="password"[^>]*autofocus', page
    )


@pytest.mark.parametrize("typed", ["anna", "Anna", "ANNA", " aNNa "])
def test_the_case_of_a_name_plays_no_part(typed, client):
    assert client.post("/login/", {**RIGHT, "username": typed}).status_code == 302


@pytest.mark.parametrize("typed", ["émile", "Émile", "ÉMILE"])
def test_the_case_of_other_letters_plays_no_part_either(typed, client):
    User.objects.create_user("Émile", password=RIGHT["password"])
    assert client.post("/login/", {**RIGHT, "username": typed}).status_code == 302


def test_two_whose_names_differ_in_case_alone_log_in_by_their_own(client):
    User.objects.create_user("Carla", password="the first one")
    User.objects.create_user("carla", password="the second one")
    for name, password, status in (
        ("Carla", "the first one", 302),
        ("carla", "the second one", 302),
        ("carla", "the first one", 200),
        ("CARLA", "the first one", 200),
    ):
        assert (
            client.post("/login/", {"username": name, "password": password}).status_code == status
        )
        client.logout()
