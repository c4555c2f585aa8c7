"""A campaign of many prompts is launched by a job: the same campaign, asked for by the same page and route."""

from __future__ import annotations

from decimal import Decimal
from http import HTTPStatus

import pytest

from annotations import background
from annotations.background.carrying_out_jobs import carry_out
from annotations.campaigns import launching_job
from annotations.models import Job, JobKind
from annotations.models.background import Status
from tests.annotations.web.campaigns.test_campaign_pages import sent
from tests.conftest import client_of

PAGE, ROUTE = "/w/home/campaigns/new/", "/api/v1/worlds/home/campaigns/"
PAID = {"price": "1.50", "ends_at": "2999-12-31", "seed": "4"}


@pytest.fixture(autouse=True)
def few_at_once(transactional_db, monkeypatch):
    monkeypatch.setattr(launching_job, "MOST_PROMPTS", 2)


def asked() -> Job:
    return Job.objects.get(kind=JobKind.LAUNCH)


def done(job: Job) -> Job:
    """The job after a worker has carried it out."""
    carry_out(background.claim("a worker", "quick", Job, job))
    job.refresh_from_db()
    return job


def test_a_large_campaign_is_launched_by_one_job_as_at_once(adam, household, admin, monkeypatch):
    values = sent(household, launch="1", name="large", **PAID)
    answers = [adam.post(PAGE, values) for _ in range(2)]
    job = asked()
    assert [answer.url for answer in answers] == [f"/jobs/{job.pk}/"] * 2
    assert not household.campaigns.exists()
    assert done(job).status == Status.SUCCEEDED
    large = household.campaigns.get()
    assert (large.price, large.ends_at.year, large.created_by) == (Decimal("1.50"), 3000, admin)
    assert job.report == {"campaign": large.pk, "name": "large", "prompts": large.prompts.count()}
    address = f"/w/home/campaigns/{large.pk}/"
    assert f'href="{address}"' in adam.get(f"/jobs/{job.pk}/").content.decode()
    monkeypatch.setattr(launching_job, "MOST_PROMPTS", 10_000)
    adam.post(PAGE, {**values, "name": "at once"})
    at_once = household.campaigns.get(name="at once")
    assert list(at_once.prompts.values_list("shown")) == list(large.prompts.values_list("shown"))


def test_a_preview_of_a_large_campaign_is_a_job_that_stores_nothing(adam, household):
    assert adam.post(PAGE, sent(household, preview="1")).url == f"/jobs/{asked().pk}/"
    report = done(asked()).report
    assert report["count"] > 50 and 5 < len(report["prompts"]) <= 8
    assert report["prompts"][0] in adam.get(f"/jobs/{asked().pk}/").content.decode()
    assert not household.campaigns.exists()


def test_a_taken_name_is_said_at_once(adam, household):
    household.campaigns.create(name="first")
    answer = adam.post(PAGE, sent(household, launch="1", name="first"))
    assert answer.status_code == HTTPStatus.UNPROCESSABLE_ENTITY
    assert "name" in answer.context["form"].errors and not Job.objects.exists()


def test_a_route_answers_with_the_job_and_a_key_asks_once(household, admin):
    client = client_of(admin)
    options = {"content_type": "application/json", "headers": {"Idempotency-Key": "monday"}}
    answers = [client.post(ROUTE, {"name": "large"}, **options) for _ in range(2)]
    for answer in answers:
        assert answer.status_code == HTTPStatus.ACCEPTED
        assert (answer.json()["id"], answer.json()["kind"]) == (asked().pk, "launch")
        assert answer["Location"].endswith(f"/api/v1/worlds/home/jobs/{asked().pk}/")
    assert answers[1]["Idempotency-Replayed"] == "true"
    launched = done(asked()).report["campaign"]
    assert client.get(f"{ROUTE}{launched}/").json()["name"] == "large"
