"""The page of the label audit, and what leads to it."""

from __future__ import annotations

import pytest
from django.core.management import call_command
from django.urls import reverse

from annotations.generation.freezing import freeze_split
from annotations.labelling.audit_findings import store_findings
from annotations.labelling.giving import next_item
from annotations.labelling.label_decisions import decide
from annotations.language.corpus.label_errors import Reason
from annotations.models import AuditFinding, FindingStatus, Job, JobKind, Paraphrase
from parser_service.labelling.precision import precision_of
from tests.doubted_labels import FEMALE, GO, MALE, doubt, say
from tests.notices import levels

PAGE = "/w/home/audit/"
HTMX = {"HX-Request": "true"}
ASKED = {"parser": "knn", "folds": 3, "to_queue": 10}


@pytest.fixture
def rows(world) -> list[Paraphrase]:
    """Three paraphrases whose labels are in doubt, the last because of a word; all are in the queue."""
    rows = [say(world, f"how many girls {number}") for number in range(3)]
    reasons = (Reason.COMMAND, Reason.COMMAND, Reason.WORD)
    suspects = [doubt(row, FEMALE, reason) for row, reason in zip(rows, reasons, strict=True)]
    store_findings(world, suspects, to_queue=3)
    return rows


@pytest.fixture
def findings(rows) -> list[AuditFinding]:
    return list(AuditFinding.objects.order_by("rank"))


def send(browser, finding, decision, query="", **values):
    path = reverse("audit_decide", args=["home", finding.pk])
    return browser.post(path + query, {"decision": decision, **values})


def listed(answer) -> list[AuditFinding]:
    return list(answer.context["listing"].rows)


def test_the_most_suspect_label_is_shown_with_everything_about_it(findings, anna):
    page = anna.get(PAGE)
    assert page.context["finding"] == findings[0] and listed(page) == findings
    for text in (
        "how many girls 0",
        "The command says so.",
        "<mark>male</mark>",
        "<mark>female</mark>",
    ):
        assert text in page.text


def test_filters_stand_in_the_address(findings, anna, annotator):
    decide(findings[1], FindingStatus.EXCLUDED, annotator)
    assert listed(anna.get(PAGE)) == [findings[0], findings[2]]
    assert listed(anna.get(f"{PAGE}?status=open&reason=word")) == [findings[2]]
    assert listed(anna.get(f"{PAGE}?status=excluded")) == [findings[1]]
    assert listed(anna.get(f"{PAGE}?q=girls+2")) == [findings[2]]
    named = anna.get(f"{PAGE}?status=excluded&finding={findings[0].pk}")
    assert named.context["finding"] == findings[0]
    assert anna.get(f"{PAGE}?finding=0").status_code == 404


def test_a_decision_goes_on_to_the_next_label_of_the_list(findings, anna):
    answer = send(anna, findings[0], "corrected", "?reason=command", reason="girls")
    assert answer["Location"] == f"{PAGE}?reason=command&finding={findings[1].pk}"
    assert findings[0].decision.reason == "girls"
    assert (
        send(anna, findings[1], "kept", "?reason=command")["Location"] == f"{PAGE}?reason=command"
    )
    assert send(anna, findings[2], "excluded")["Location"] == PAGE
    assert anna.get(PAGE).context["finding"] is None


def test_a_form_that_is_refused_stays_on_the_page(findings, anna):
    path = reverse("audit_decide", args=["home", findings[0].pk])
    answer = anna.post(path, {"decision": "corrected", "form": "(go"}, headers=HTMX)
    assert answer.status_code == 422 and answer["HX-Retarget"] == "#audit-problem"
    assert answer.context["sentence"] and 'id="audit-problem"' in answer.text
    plain = send(anna, findings[0], "corrected", form="(go")
    assert plain["Location"] == f"{PAGE}?finding={findings[0].pk}"
    assert levels(anna.get(plain["Location"])) == ["error"]
    assert findings[0].decision is None


def test_who_comes_second_is_told(findings, anna, reviewer):
    decide(findings[0], FindingStatus.KEPT, reviewer)
    answer = send(anna, findings[0], "excluded")
    told = anna.get(answer["Location"])
    assert levels(told) == ["error"] and "rene" in str(*told.context["messages"])


def test_a_decision_is_taken_back(findings, rows, anna, rene, annotator):
    made = decide(findings[0], FindingStatus.EXCLUDED, annotator)
    path = reverse("audit_take_back", args=["home", made.pk])
    assert levels(rene.post(path, follow=True)) == ["error"]
    assert findings[0].decision == made
    assert anna.post(path)["Location"] == f"{PAGE}?finding={findings[0].pk}"
    rows[0].refresh_from_db()
    assert rows[0].status == "accepted"


def test_a_form_is_checked_while_it_is_written(findings, anna):
    path = reverse("audit_check", args=["home", findings[0].pk])
    answer = anna.post(path, {"form": '(go "<room>")'}).json()
    problem = answer["problems"][-1]
    assert problem["severity"] == "warning" and "room" in problem["message"].split()


def test_one_label_alone_is_for_the_page_that_lists_them(findings, anna):
    path = reverse("audit_item", args=["home", findings[1].pk])
    assert "how many girls 1" in anna.get(path, headers=HTMX).text
    assert anna.get(path)["Location"] == f"{PAGE}?finding={findings[1].pk}"


def test_precision_counts_what_people_decided(world, findings, anna, annotator):
    assert precision_of(world) is None
    for finding, status in zip(findings, ("kept", "corrected", "excluded"), strict=True):
        decide(finding, status, annotator)
    precision = precision_of(world)
    assert (precision.decided, precision.wrong) == (3, 2)
    assert precision.interval[0] < precision.share < precision.interval[1]
    page = " ".join(anna.get(PAGE).text.split())
    assert all(f"1 {word}" in page for word in ("corrected", "excluded", "kept"))


def test_without_findings_the_page_says_what_to_do(world, anna, rene):
    start = f'action="{reverse("audit_start", args=["home"])}"'
    for browser, may_start in ((anna, False), (rene, True)):
        page = browser.get(PAGE).text
        assert '<div class="empty">' in page and (start in page) is may_start


def test_a_reviewer_starts_one_audit_at_a_time(world, rene, reviewer):
    start = reverse("audit_start", args=["home"])
    first = rene.post(start, ASKED)
    job = Job.objects.get(kind=JobKind.AUDIT)
    assert (job.arguments, job.created_by) == (ASKED, reviewer)
    assert first["Location"] == rene.post(start, ASKED)["Location"] == f"/jobs/{job.pk}/"
    assert job.title in rene.get(first["Location"]).text
    refused = rene.post(start, {**ASKED, "folds": 1}, follow=True)
    assert levels(refused) == ["error"] and "folds" in str(*refused.context["messages"])
    assert Job.objects.count() == 1


def test_the_work_queue_leads_to_the_page_and_back(world, findings, anna, annotator):
    answer = anna.post(reverse("queue_next", args=["home"]))
    assert answer["Location"] == f"{PAGE}?finding={findings[0].pk}"
    item = next_item(annotator, world).item
    path = reverse("queue_item", args=["home", item.pk])
    assert 'name="step" value="done"' in anna.get(path).text
    anna.post(reverse("queue_act", args=["home", item.pk]), {"step": "done"})
    findings[0].refresh_from_db()
    assert findings[0].status == FindingStatus.KEPT


def test_the_overview_counts_the_labels_in_doubt(sample, findings, rene):
    page = rene.get("/w/home/")
    tasks = [each for group in page.context["work_groups"] for each in group.items]
    (doubted,) = [each for each in tasks if each.url.startswith(PAGE)]
    assert doubted.count == 3 and doubted.sentence in page.text


def test_a_split_says_which_of_its_pairs_were_found_wrong(
    world, findings, rows, anna, annotator, tmp_path, capsys
):
    for text in ("go there", "walk there", "move there"):
        say(world, text, GO)
    split = freeze_split(world, "old")
    decide(findings[0], FindingStatus.CORRECTED, annotator)
    page = anna.get(reverse("split", args=["home", split.pk]))
    assert page.context["wrong"] == 1
    call_command("export_split", "home", "old", "--output", str(tmp_path / "old"), "--json")
    assert '"pairs_found_wrong_since": 1' in capsys.readouterr().out
    assert split.examples.filter(utterance=rows[0].utterance).get().logical_form == MALE
