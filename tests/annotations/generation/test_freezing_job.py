"""A split of many pairs is frozen by a job: the same split, asked for by the same pages and routes."""

from __future__ import annotations

from http import HTTPStatus

import pytest

from annotations import background
from annotations.background.carrying_out_jobs import carry_out
from annotations.generation import freezing_job
from annotations.generation.freezing import freeze_split
from annotations.models import Example, Job, JobKind, Split
from annotations.models.background import Status
from tests.annotations.generation.test_freezing import full  # noqa: F401
from tests.conftest import client_of
from tests.sample_world import make_paraphrase

PAGE, ROUTE = "/w/home/splits/new/", "/api/v1/worlds/home/splits/"
SHARES = {"train": "70", "validation": "10", "test": "20"}
CHOSEN = {"name": "mine", "criterion": "logical_form", "seed": "7", **SHARES}
SENT = {"name": "mine", "criterion": "logical_form", "seed": 7}
JSON = "application/json"


@pytest.fixture(autouse=True)
def few_at_once(transactional_db, monkeypatch):
    monkeypatch.setattr(freezing_job, "MOST_EXAMPLES", 2)


def asked() -> Job:
    return Job.objects.get(kind=JobKind.FREEZE)


def done(job: Job) -> Job:
    """The job after a worker has carried it out."""
    carry_out(background.claim("a worker", "quick", Job, job))
    job.refresh_from_db()
    return job


def pairs_of(split: Split) -> list[tuple[object, ...]]:
    columns = ("source", "part", "position", "utterance", "logical_form")
    return list(Example.objects.filter(split=split).order_by("pk").values_list(*columns))


def test_a_large_split_is_frozen_by_one_job_as_at_once(full, anna, annotator):  # noqa: F811
    answers = [anna.post(PAGE, {**CHOSEN, "freeze": "1"}) for _ in range(2)]
    job = asked()
    assert [answer.url for answer in answers] == [f"/jobs/{job.pk}/"] * 2
    assert not full.splits.exists()
    assert done(job).status == Status.SUCCEEDED
    frozen = full.splits.get()
    assert (frozen.name, frozen.seed, frozen.created_by) == ("mine", 7, annotator)
    assert pairs_of(frozen) == pairs_of(freeze_split(full, "at-once", "logical_form", 7))
    assert job.report == {"split": frozen.pk, "name": "mine", "examples": len(pairs_of(frozen))}
    assert f'href="/w/home/splits/{frozen.pk}/"' in anna.get(f"/jobs/{job.pk}/").content.decode()


def test_a_preview_of_a_large_split_is_a_job_that_stores_nothing(full, anna):  # noqa: F811
    assert anna.post(PAGE, {**CHOSEN, "preview": "1"}).url == f"/jobs/{asked().pk}/"
    report = done(asked()).report
    assert sum(each["total"] for each in report["counts"]) == full.commands.count() * 3
    assert anna.get(f"/jobs/{asked().pk}/").context["counts"] == report["counts"]
    assert not full.splits.exists()


def test_a_large_split_is_frozen_anew_by_a_job(full, anna):  # noqa: F811
    old = freeze_split(full, "old")
    make_paraphrase(full, utterance="something new", grounded_form="go", logical_form="go")
    for _ in range(2):
        assert anna.post(f"/w/home/splits/{old.pk}/renew/").url == f"/jobs/{asked().pk}/"
    job = done(asked())
    assert job.report["name"] == "old-2"
    assert full.splits.get(pk=job.report["split"]).follows == old
    assert anna.post(f"/w/home/splits/{old.pk}/renew/").url == f"/w/home/splits/{old.pk}/"


def test_what_has_not_changed_fails_the_job(full, anna):  # noqa: F811
    anna.post(f"/w/home/splits/{freeze_split(full, 'old').pk}/renew/")
    job = done(asked())
    assert (job.status, job.report) == (Status.FAILED, None) and job.failure
    assert full.splits.count() == 1


def test_a_route_answers_with_the_job_and_a_key_asks_once(full, annotator):  # noqa: F811
    client = client_of(annotator)
    options = {"content_type": JSON, "headers": {"Idempotency-Key": "monday"}}
    answers = [client.post(ROUTE, SENT, **options) for _ in range(2)]
    job = asked()
    for answer in answers:
        assert answer.status_code == HTTPStatus.ACCEPTED
        assert (answer.json()["id"], answer.json()["kind"]) == (job.pk, "freeze")
        assert answer["Location"].endswith(f"/api/v1/worlds/home/jobs/{job.pk}/")
    assert answers[1]["Idempotency-Replayed"] == "true"
    shown = client.get(answers[0]["Location"]).json()
    assert (shown["status"], shown["report"]) == ("queued", None)
    frozen = done(job).report["split"]
    assert client.get(f"{ROUTE}{frozen}/").json()["name"] == "mine"
    assert client.post(ROUTE, SENT, content_type=JSON).status_code == HTTPStatus.BAD_REQUEST


def test_a_route_answers_with_the_job_that_freezes_anew(full, annotator):  # noqa: F811
    old = freeze_split(full, "old")
    answer = client_of(annotator).post(f"{ROUTE}{old.pk}/renew/")
    assert (answer.status_code, answer.json()["id"]) == (HTTPStatus.ACCEPTED, asked().pk)


def test_an_annotator_may_stop_it(full, anna, rene):  # noqa: F811
    anna.post(PAGE, {**CHOSEN, "freeze": "1"})
    cancel = f"/jobs/{asked().pk}/cancel/"
    assert rene.post(cancel).status_code == HTTPStatus.FORBIDDEN
    anna.post(cancel)
    assert asked().status == Status.CANCELLED
