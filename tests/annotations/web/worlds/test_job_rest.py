"""Imports, generation and jobs over the API; history, restored rows and other names."""

from __future__ import annotations

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile
from django.template.loader import get_template

from annotations.models import Entity, Job, JobKind, SemanticTemplate
from annotations.web.worlds.report_presentation import QUESTIONS, REMOVAL_QUESTION, shown_report
from tests.annotations.conftest import TINY, as_bytes

HOME = "worlds/home/"


@pytest.fixture
def call(call_as, admin, monkeypatch):
    """A function: the answer to a request of the admin; data is JSON, unless it is a form with files."""
    monkeypatch.setattr("annotations.background.waking.send_wake_up", lambda queue: None)
    return lambda method, path, data=None, files=None, **headers: call_as(
        admin, method, HOME + path, data, files, **headers
    )


def uploads(**changes: str) -> dict[str, object]:
    texts = as_bytes({**TINY, **changes})
    return {"files": [SimpleUploadedFile(name, data) for name, data in texts.items()]}


def test_files_are_imported_with_the_report_of_the_page(call, world):
    done = call("post", "import/", files=uploads(), idempotency_key="k")
    assert done.status_code == 200, done.json()
    assert done.json()["report"]["templates"] == {"1": 2}
    again = call("post", "import/", files=uploads(), idempotency_key="k")
    assert again["Idempotency-Replayed"] == "true"
    other = uploads(**{"common_rules.txt": "; grammar name Common\n"})
    assert call("post", "import/", files=other, idempotency_key="k").status_code == 422
    generated = call("post", "generate/").json()["report"]
    assert generated["changes"]["added"] == world.commands.count() + world.logical_forms.count()
    archive = call("get", "download/")
    assert b"".join(archive.streaming_content).startswith(b"PK")


def test_problems_of_files_come_with_their_places(call, world):
    name = "tiny_category_1_semantics.txt"
    answer = call("post", "import/", files=uploads(**{name: TINY[name] + "go = (go\n"}))
    assert (answer.status_code, answer["Content-Type"]) == (422, "application/problem+json")
    errors = [each for each in answer.json()["problems"] if each["severity"] == "error"]
    assert (errors[0]["file"], errors[0]["line"]) == (name, 4)
    assert not SemanticTemplate.objects.exists()


def test_what_would_remove_something_asks(call, tiny_world):
    name = "common_rules.txt"
    fewer = uploads(**{name: TINY[name].replace("find | locate", "find")})
    asked = call("post", "import/", files=fewer)
    assert asked.status_code == 202
    job = asked.json()["job"]
    assert job["is_waiting_for_answer"]
    path = f"jobs/{job['id']}/"
    assert asked["Location"].endswith(path)
    answered = call("post", f"{path}answer/")
    assert (answered.status_code, answered.json()["status"]) == (202, "queued")
    assert call("post", f"{path}answer/").status_code == 409
    queued = f"jobs/{answered.json()['id']}/"
    assert call("post", f"{queued}cancel/").json()["status"] == "cancelled"
    assert {row["id"] for row in call("get", "jobs/").json()["results"]} == set(
        Job.objects.values_list("pk", flat=True)
    )


def test_a_row_is_renamed_and_its_history_restored(call, tiny_world, admin):
    row = Entity.objects.get(text="tea")
    path = f"rename/entity/{row.pk}/"
    assert call("post", path, {"new": "green tea"}).status_code == 428
    renamed = call("post", path, {"new": "green tea"}, if_match='"1"')
    assert renamed.json()["row"]["text"] == "green tea", renamed.json()
    assert call("post", path, {"new": "chai"}, if_match='"1"').status_code == 412
    assert call("post", path, {"new": "milk"}, if_match="*").status_code == 400
    versions = call("get", f"history/entity/{row.pk}/").json()["results"]
    assert [each["values"]["text"] for each in versions] == ["green tea", "tea"]
    assert versions[0]["by"] == admin.username
    back = call("post", f"history/entity/{row.pk}/", {"entry": versions[1]["entry"]})
    assert back.json()["row"]["text"] == "tea"
    call("delete", f"entities/{row.pk}/", if_match="*")
    (gone,) = call("get", "deleted/entity/").json()["results"]
    assert gone["is_deletion"]
    call("post", f"history/entity/{row.pk}/", {"entry": gone["entry"]})
    assert call("get", f"entities/{row.pk}/").json()["text"] == "tea"
    assert call("get", f"history/moon/{row.pk}/").status_code == 404


def test_the_report_of_every_kind_of_job_has_a_page():
    reports = {shown_report(kind, {})["report_template"] for kind in JobKind}
    for template in {*reports, *QUESTIONS.values(), REMOVAL_QUESTION}:
        get_template(template)
