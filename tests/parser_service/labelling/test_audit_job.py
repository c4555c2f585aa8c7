"""The audit as a job of a worker."""

from __future__ import annotations

import pytest

from annotations import background
from annotations.background import Stopped
from annotations.background.carrying_out_jobs import carry_out
from annotations.background.requesting import request_job
from annotations.background.watching import JobProgress
from annotations.labelling.label_decisions import decide
from annotations.models import FindingStatus, Job, JobKind
from annotations.models.background import Status
from tests.parser_service.commands.test_audit_labels import FIND, GO, SAID, say

ASKED = {"parser": "knn", "folds": 3, "to_queue": 1}


@pytest.fixture
def pairs(transactional_db, sample):
    """Three pairs whose labels are right and one whose label is wrong, which is returned."""
    for prompt, (form, utterance) in SAID.items():
        say(sample.world, prompt, utterance, form)
    return say(sample.world, "locate the tea", "look for the tea", GO)


def request(by=None, **changes) -> Job:
    return request_job(JobKind.AUDIT, "home", by, {**ASKED, **changes})


def done(job: Job) -> Job:
    """The job after a worker has carried it out."""
    carry_out(background.claim("a worker", "quick", Job, job))
    job.refresh_from_db()
    return job


def test_a_worker_stores_what_it_finds(pairs, reviewer):
    job = done(request(reviewer))
    assert (job.status, job.failure) == (Status.SUCCEEDED, "")
    first = pairs.world.audit_findings.first()
    assert (first.paraphrase, first.form, first.suggested_form) == (pairs, GO, FIND)
    assert first.anonymized_text == "look for the <object>"
    assert pairs.world.work_items.get().paraphrase == pairs
    assert job.report["pairs"] == 4 and job.report["reasons"]["command"] == 1
    assert job.report["open"] == job.report["new"] == pairs.world.audit_findings.count()


def test_an_audit_that_is_repeated_leaves_decisions_alone(pairs, annotator):
    done(request())
    decide(pairs.audit_findings.get(), FindingStatus.KEPT, annotator)
    report = done(request()).report
    assert (report["new"], report["decided"]) == (0, 1)
    assert pairs.audit_findings.get().status == FindingStatus.KEPT


def test_what_is_excluded_is_not_audited_again(pairs, annotator):
    done(request())
    decide(pairs.audit_findings.get(), FindingStatus.EXCLUDED, annotator)
    assert done(request()).report["pairs"] == 3


def test_too_few_pairs_are_the_failure(pairs):
    job = done(request(folds=9))
    assert (job.status, job.report) == (Status.FAILED, None)
    assert " 9 " in job.failure


@pytest.mark.parametrize("message", ["fold 2 of 3", "ranking the labels"])
def test_a_cancelled_audit_stores_nothing(message, pairs, monkeypatch):
    report = JobProgress.report
    messages = []

    def stop(progress, fraction, text):
        messages.append(text)
        if text == message:
            raise Stopped
        report(progress, fraction, text)

    monkeypatch.setattr(JobProgress, "report", stop)
    assert done(request()).status == Status.CANCELLED
    assert messages[:3] == ["reading the pairs", "fold 1 of 3", "fold 2 of 3"]
    assert not pairs.world.audit_findings.exists()


def test_a_worker_that_lost_the_job_stores_nothing(pairs, monkeypatch):
    job = request()

    def lose(progress, fraction, message):
        Job.objects.filter(pk=job.pk).update(attempt=7)

    monkeypatch.setattr(JobProgress, "report", lose)
    done(job)
    assert not pairs.world.audit_findings.exists()
