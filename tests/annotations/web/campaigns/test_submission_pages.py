from __future__ import annotations

import pytest

from annotations.campaigns.answering import save_answer
from annotations.campaigns.tasks import begin
from annotations.models import Paraphrase, Submission
from tests.launched_campaigns import small_campaign
from tests.notices import levels


@pytest.fixture
def rows(world) -> list[Submission]:
    """Two rewrites, one of which is a copy, and a free command."""
    contributor = begin(small_campaign(world), "f00d")
    texts = {"rewrite": "{}, please", "free": "water the flowers in the garden"}
    for place in contributor.submissions.all():
        shown = place.prompt.shown if place.prompt else ""
        text = texts[place.kind].format(shown) if place.position != 2 else "do something new today"
        save_answer(place, text, 30)
    return list(contributor.submissions.order_by("position"))


def listed(answer) -> set[int]:
    return {row.pk for row in answer.context["listing"].rows}


def test_the_list_has_what_waits_with_its_flags(rows, rene):
    assert listed(rene.get("/w/home/submissions/?status=pending")) == {row.pk for row in rows}
    assert listed(rene.get("/w/home/submissions/?flag=copy")) == {rows[0].pk}
    assert listed(rene.get("/w/home/submissions/?flag=lost_entity")) == {rows[1].pk}
    assert listed(rene.get("/w/home/submissions/?flag=none")) == {rows[2].pk}
    assert listed(rene.get("/w/home/submissions/?kind=free")) == {rows[2].pk}
    assert not listed(rene.get("/w/home/submissions/?status=accepted"))


def test_those_ticked_are_decided_about_and_it_can_be_undone(rows, rene):
    keys = [row.pk for row in rows[:2]]
    answer = rene.post(
        "/w/home/submissions/decide/", {"row": keys, "decision": "accept"}, follow=True
    )
    assert levels(answer) == ["success"]
    assert Paraphrase.objects.count() == 2
    assert listed(answer) == {rows[2].pk}
    at = Submission.objects.get(pk=keys[0]).decided_at.isoformat()
    rene.post("/w/home/submissions/take-back/", {"at": at})
    assert not Paraphrase.objects.exists()
    assert not Submission.objects.exclude(status="pending").exists()


def test_nothing_ticked_decides_nothing(rows, rene):
    for sent in (
        {},
        {"decision": "accept"},
        {"row": rows[0].pk},
        {"row": "x", "decision": "reject"},
    ):
        answer = rene.post("/w/home/submissions/decide/", sent, follow=True)
        assert levels(answer) == ["warning"]
    assert not Submission.objects.exclude(status="pending").exists()


def test_after_a_decision_comes_the_next_one_that_waits(rows, rene):
    for row, following in ((rows[1], rows[2]), (rows[2], rows[0])):
        answer = rene.post(f"/w/home/submissions/{row.pk}/decide/", {"decision": "reject"})
        assert answer.url == f"/w/home/submissions/{following.pk}/"
    answer = rene.post(f"/w/home/submissions/{rows[0].pk}/decide/", {"decision": "accept"})
    assert answer.url == "/w/home/submissions/?status=pending"


def test_a_form_that_cannot_be_read_keeps_what_was_typed(rows, rene):
    sent = {"decision": "form", "form": "( go"}
    answer = rene.post(f"/w/home/submissions/{rows[0].pk}/decide/", sent)
    assert answer.status_code == 422
    assert answer.context["error"]
    assert "( go" in answer.content.decode()
    assert Submission.objects.get(pk=rows[0].pk).status == "pending"


def test_a_page_of_a_submission_costs_few_queries(rows, rene, django_assert_max_num_queries):
    with django_assert_max_num_queries(25):
        assert rene.get(f"/w/home/submissions/{rows[0].pk}/").status_code == 200


def test_planted_checks_are_not_moderated(rows, rene):
    rows[0].kind = "check"
    rows[0].save()
    assert rows[0].pk not in listed(rene.get("/w/home/submissions/"))
    assert rene.get(f"/w/home/submissions/{rows[0].pk}/").status_code == 404


def test_programs_moderate_by_pseudonym(rows, reviewer, call_as):
    def call(method: str, path: str = "", sent: dict | None = None):
        return call_as(reviewer, method, f"worlds/home/submissions/{path}", sent)

    shown = call("get").json()["results"]
    assert [each["contributor"] for each in shown] == ["f00d"] * 3
    assert shown[0]["flags"][0]["code"] == "copy"
    decided = call("post", "decide/", {"ids": [rows[1].pk], "decision": "accept"})
    assert decided.json() == {"decided": 1}
    mended = call("post", f"{rows[0].pk}/mend/", {"text": "bring an apple"}).json()
    assert (mended["text"], mended["raw"]) == ("bring an apple", rows[0].text)
    assert call("post", f"{rows[1].pk}/take-back/").json()["status"] == "pending"
    assert call("post", f"{rows[1].pk}/take-back/").status_code == 409
