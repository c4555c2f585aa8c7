from __future__ import annotations

import pytest

from annotations.language.corpus import INSTRUCTIONS
from annotations.models import Job
from tests.launched_campaigns import small_campaign
from tests.parser_service.llm_server import MODEL, installed_tiny_server

SENT = {
    "model": MODEL,
    "wordings": "2",
    "budget": "10",
    "temperature": "0.5",
    "seed": "3",
    "instructions": INSTRUCTIONS,
}


@pytest.fixture
def tiny(tmp_path):
    with installed_tiny_server(tmp_path) as server:
        yield server


@pytest.fixture
def path(world) -> str:
    return f"campaigns/{small_campaign(world).pk}/model/"


def test_a_model_is_asked_by_a_job(path, adam, tiny):
    answer = adam.post(f"/w/home/{path}", SENT)
    job = Job.objects.get()
    assert answer.url == f"/jobs/{job.pk}/"
    assert (job.kind, job.arguments["model"]) == ("paraphrase", MODEL)
    assert (job.arguments["temperature"], job.arguments["seed"]) == (0.5, 3)
    adam.post(f"/w/home/{path}", SENT)
    assert Job.objects.count() == 1


@pytest.mark.parametrize(
    ("field", "value"),
    [("model", ""), ("wordings", "0"), ("temperature", "3"), ("instructions", "say it again")],
)
def test_what_is_no_setting_is_said_at_its_field(path, adam, tiny, field, value):
    answer = adam.post(f"/w/home/{path}", {**SENT, field: value})
    assert answer.status_code == 422
    assert set(answer.context["form"].errors) == {field}
    assert not Job.objects.exists()


def test_without_a_server_the_page_says_what_to_do(path, adam):
    assert "GPSR_LLM_URL" in adam.get(f"/w/home/{path}").context["problem"]
    assert adam.post(f"/w/home/{path}", SENT).status_code == 422


def test_programs_ask_likewise(path, admin, call_as, tiny):
    answer = call_as(admin, "post", f"worlds/home/{path}", {"model": MODEL})
    assert answer.status_code == 202
    assert answer.json()["kind"] == "paraphrase"
