"""The error analysis as a job: what it finds, and what a cancelled or killed one leaves."""

from __future__ import annotations

import pytest

from annotations.background import Stopped
from annotations.background.progress import UNWATCHED
from annotations.background.requesting import cancel_job, request_job
from annotations.background.watching import JobProgress
from annotations.models import JobKind
from parser_service.models import ProbeAnswer
from parser_service.reviews import stored_findings as findings_module
from parser_service.reviews.analysis_job import names_of_steps
from parser_service.reviews.refusal_curves import refusal_findings
from parser_service.reviews.state import analysis_of
from parser_service.reviews.stored_findings import findings_of
from parser_service.reviews.target import Target
from parser_service.runs.analysis_requests import analysis_jobs, request_analysis
from parser_service.runs.checkpoints import model_folder, remove_folder
from tests.parser_service.reviews.analyses.conftest import analyse_again, done
from tests.parser_service.reviews.analyses.made_parsers import DEFAULT, WORD


def test_a_finished_run_is_analysed_by_itself_once(train_one):
    run = train_one("perfect")
    job = analysis_jobs(run).get()
    assert (job.status, job.queue, job.arguments) == ("queued", run.queue, {"run": run.pk})
    assert request_analysis(run) == job
    assert not analysis_of(run).is_complete and analysis_of(run).is_active


def test_everything_is_found_and_stored(analysed):
    run = analysed("perfect")
    assert set(findings_of(run, "validation")) == names_of_steps()
    assert {"attractors", "risk_coverage"} <= set(findings_of(run, "test"))
    state = analysis_of(run)
    assert state.is_complete and not state.is_active and state.made_at
    assert run.probes.count() == ProbeAnswer.objects.filter(probe__run=run).count() > 50
    assert analysis_jobs(run).get().report["probes"] == run.probes.count()


def test_a_parser_that_always_answers_one_form_is_the_top_attractor(analysed):
    run = analysed("always-one")
    for part in ("validation", "test"):
        for rows in findings_of(run, part)["attractors"].values():
            assert [(row["form"], row["is_attractor"]) for row in rows] == [(DEFAULT, True)]
            assert rows[0]["predicted"] == 6 and len(rows[0]["inputs"]) == 5
    unknown = run.probes.filter(expectation="unknown")
    assert unknown and not unknown.filter(answer__is_expected=True).exists()


def test_a_parser_that_looks_at_a_single_word_is_reported_with_it(analysed):
    findings = findings_of(analysed("one-word"), "validation")
    assert findings["deciding_words"]["single"] == WORD
    assert findings["deciding_words"]["words"][0]["word"] == WORD


def test_a_perfect_parser_is_reported_for_neither(analysed):
    run = analysed("perfect")
    findings = findings_of(run, "validation")
    assert findings["attractors"] == {"para": [], "gen": []}
    assert findings["deciding_words"]["single"] is None
    assert findings["pairs"]["flips"] == 0
    assert not run.probes.filter(answer__is_expected=False).exists()
    by_kind = {row["kind"]: row for row in findings["sensitivity"]}
    assert by_kind["politeness"]["flip_rate"] == 0
    assert by_kind["all"]["consistency"] == 1


def test_refusing_everything_withholds_every_error(analysed):
    curve = findings_of(analysed("always-one"), "validation")["risk_coverage"]["para"]
    assert (curve["count"], curve["correct"], curve["unanswered"]) == (6, 0, 0)
    assert curve["bounds"] == [None, 1.0]
    assert (curve["answered"], curve["wrong"], curve["spared"]) == ([0, 6], [0, 6], [6, 0])
    assert curve["no_probability"]


@pytest.mark.parametrize(
    ("kind", "error", "brier"), [("probability", 1.0, 1.0), ("log_probability", 1.0, 1.0)]
)
def test_scores_that_are_probabilities_are_measured(analysed, kind, error, brier):
    """It is sure of every answer, and all are wrong."""
    run = analysed("always-one")
    run.score_kind = kind
    target = Target(run, "validation")
    curve = refusal_findings(target, UNWATCHED)["para"]
    assert (curve["calibration_error"], curve["brier_score"]) == (error, brier)


def test_every_error_has_a_proposal_which_knows_the_default(analysed):
    run = analysed("always-one")
    reviews = run.reviews.proposed()
    assert reviews.count() == run.predictions.best().filter(is_exact_match=False).count() == 24
    assert {review.category.code for review in reviews} == {"unexpected_default"}
    assert not analysed("perfect").reviews.exists()


def stop_at(monkeypatch, message: str, calls: int = 1) -> None:
    """Let the job be cancelled when it reports ``message`` for the given time."""
    report, seen = JobProgress.report, []

    def stop(progress, fraction, text):
        seen.append(text)
        if sum(message in each for each in seen) == calls:
            raise Stopped
        report(progress, fraction, text)

    monkeypatch.setattr(JobProgress, "report", stop)


@pytest.mark.parametrize("message", ["making probes", "asking the parser", "deciding words"])
def test_a_cancelled_analysis_keeps_what_it_has_found_and_the_next_goes_on(
    message, train_one, monkeypatch
):
    run = train_one("one-word")
    with monkeypatch.context() as patch:
        stop_at(patch, message)
        assert done(analysis_jobs(run).get()).status == "cancelled"
    before = findings_of(run, "validation")
    assert "attractors" in before and set(before) < names_of_steps()
    assert analysis_of(run).is_partial
    assert analyse_again(run).status == "succeeded"
    assert analysis_of(run).is_complete


def test_probes_that_were_answered_are_not_asked_again(train_one, monkeypatch):
    run = train_one("one-word")
    with monkeypatch.context() as patch:
        stop_at(patch, "asking the parser its probes", calls=4)
        done(analysis_jobs(run).get())
    answered = dict(ProbeAnswer.objects.values_list("probe", "pk"))
    assert 0 < len(answered) < run.probes.count()
    made = list(run.probes.values_list("pk", flat=True))
    analyse_again(run)
    assert list(run.probes.values_list("pk", flat=True)) == made
    assert answered.items() <= dict(ProbeAnswer.objects.values_list("probe", "pk")).items()
    assert ProbeAnswer.objects.count() == len(made)


def test_findings_of_older_code_are_made_again(analysed, monkeypatch):
    run = analysed("always-one")
    monkeypatch.setattr(findings_module, "VERSION", findings_module.VERSION + 1)
    assert findings_of(run, "validation") == {}
    analyse_again(run)
    assert set(findings_of(run, "validation")) == names_of_steps()
    assert run.analyses.count() == 2


def test_without_its_model_a_run_is_analysed_as_far_as_that_goes(train_one):
    run = train_one("perfect")
    remove_folder(model_folder(run.pk))
    job = done(analysis_jobs(run).get())
    assert job.status == "failed" and str(model_folder(run.pk)) in job.failure
    assert "pairs" in findings_of(run, "validation")
    assert analysis_of(run).failure == job.failure


@pytest.mark.parametrize("arguments", [{"run": 10**9}, {}])
def test_a_run_that_is_gone_is_the_failure(arguments, home):
    job = done(request_job(JobKind.ANALYSE, "home", None, arguments))
    assert job.status == "failed" and "(" not in job.failure  # no fault of the program


def test_a_run_of_another_world_is_not_analysed(train_one, other_world):
    run = train_one("perfect")
    job = done(request_job(JobKind.ANALYSE, other_world.name, None, {"run": run.pk}))
    assert job.status == "failed" and not run.analyses.exists()


def test_a_queued_analysis_is_cancelled_at_once(train_one):
    run = train_one("perfect")
    cancel_job(analysis_jobs(run).get())
    assert not analysis_of(run).is_active and not analysis_jobs(run).active().exists()
