"""The page and the routes that say how large the language of a world is, and make all of it or a sample."""

from __future__ import annotations

from http import HTTPStatus

import pytest

from annotations.generation import language_size
from annotations.models import Command, Job, JobKind, World
from tests.conftest import client_of

PAGE = "/w/home/generation/"
GENERATE = "/api/v1/worlds/home/generate/"
LANGUAGE = "/api/v1/worlds/home/generation/"


def world_now() -> World:
    return World.objects.get(name="home")


def test_the_page_says_the_size_before_anything_is_made(tiny_world, anna):
    page = anna.get(PAGE)
    assert page.context["size"] == "3"
    assert not page.context["is_too_large"]
    assert not Command.objects.exists()


def test_the_page_draws_a_sample_and_offers_the_same_one_again(tiny_world, anna):
    answer = anna.post(PAGE, {"sample": 2, "seed": 9, "balanced": "forms"})
    assert answer.status_code == HTTPStatus.FOUND
    note = world_now().sample_note
    assert note is not None
    assert str(note) in anna.get("/w/home/commands/").content.decode()
    assert anna.get(PAGE).context["form"].initial == {"sample": 2, "seed": 9, "balanced": "forms"}


def test_an_empty_number_makes_all_commands(tiny_world, anna):
    anna.post(PAGE, {"sample": 2})
    anna.post(PAGE, {"sample": "", "seed": "", "balanced": "none"})
    assert world_now().sample == {}
    assert Command.objects.count() == 3


def test_the_button_makes_the_same_sample_again(tiny_world, anna):
    anna.post(PAGE, {"sample": 2, "seed": 3})
    before = world_now().sample
    anna.post("/w/home/generate/")
    assert world_now().sample == before


@pytest.mark.parametrize(
    "sent", [{"sample": -1}, {"sample": 10**7}, {"seed": 2**63}, {"balanced": "x"}]
)
def test_what_is_no_sample_is_refused(sent, tiny_world, anna):
    assert anna.post(PAGE, sent).status_code == HTTPStatus.UNPROCESSABLE_ENTITY
    assert not Command.objects.exists()


def test_a_sample_of_a_large_language_is_one_job_that_pages_lead_to(tiny_world, anna, monkeypatch):
    monkeypatch.setattr(language_size, "MOST_COMMANDS", 2)
    sent = {"sample": 1, "seed": 1, "balanced": "lines"}
    answers = [anna.post(PAGE, sent) for _ in range(2)]
    job = Job.objects.get(kind=JobKind.GENERATE)
    assert job.arguments == sent
    assert [answer.url for answer in answers] == [f"/jobs/{job.pk}/"] * 2
    assert f'href="/jobs/{job.pk}/"' in anna.get("/w/home/templates/").content.decode()


def test_a_reviewer_neither_sees_the_page_nor_draws(tiny_world, rene):
    assert rene.get(PAGE).status_code == HTTPStatus.FORBIDDEN
    assert rene.post(PAGE, {"sample": 2}).status_code == HTTPStatus.FORBIDDEN


def test_pages_of_coverage_splits_and_campaigns_say_that_it_is_a_sample(tiny_world, anna, adam):
    anna.post(PAGE, {"sample": 2})
    said = str(world_now().sample_note)
    for page in ("commands/", "forms/", "commands/complexity/", "coverage/", "splits/new/"):
        assert said in anna.get(f"/w/home/{page}").content.decode(), page
    assert said in adam.get("/w/home/campaigns/new/").content.decode()
    anna.post("/w/home/splits/new/", {"name": "one", "criterion": "command", "freeze": 1})


def test_routes_say_the_size_and_draw_a_sample(tiny_world, annotator):
    client = client_of(annotator)
    assert client.get(LANGUAGE).json() == {"derivations": "3", "sample": None}
    body = {"sample": 2, "seed": 5, "balanced": "lines"}
    report = client.post(GENERATE, body, content_type="application/json").json()["report"]
    note = {"commands": 2, "of": "3", "is_all": False, "size": 2, "seed": 5, "balanced": "lines"}
    assert report["sample"] == note
    assert client.get(LANGUAGE).json()["sample"] == note
    assert client.get("/api/v1/worlds/home/").json()["sample"] == note


def test_a_route_refuses_what_is_no_sample(tiny_world, annotator):
    client = client_of(annotator)
    for body in ({"sample": -1}, {"sample": 2, "balanced": "x"}, {"size": 2}):
        answer = client.post(GENERATE, body, content_type="application/json")
        assert answer.status_code == HTTPStatus.BAD_REQUEST
