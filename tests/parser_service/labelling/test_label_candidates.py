"""Candidates: from where, in which order, and from a worker where a parser is asked."""

from __future__ import annotations

from contextlib import contextmanager

import pytest
from django.db import connection
from django.test.utils import CaptureQueriesContext

from annotations import background
from annotations.background.carrying_out_jobs import carry_out
from annotations.background.progress import UNWATCHED, Unwatched
from annotations.generation.freezing import plan_split
from annotations.labelling.collecting import collect
from annotations.labelling.label_answers import label
from annotations.labelling.proposal_requests import request_proposals
from annotations.language.forms import canonical_text, read_form
from annotations.models import Job, JobKind, Proposal, Verdict
from parser_service.labelling.label_candidates import MOST_CANDIDATES, candidates_for
from parser_service.labelling.parser_proposals import enqueue_doubts
from parser_service.runs import lifecycle
from parser_service.runs.train_run import train
from tests.parser_service.requests import ask

FIND = '( find ( lambda $1 e ( is_a $1 " <object> " ) ) )'
GO = '( go " <room> " )'


@pytest.fixture
def said(sample):
    collect(sample.world, ["would you find me the tea", "go to the kitchen"])
    return list(sample.world.utterances.order_by("pk"))


def test_candidates_are_few_distinct_and_canonical(said):
    for row in said:
        forms = [each.form for each in candidates_for(row)]
        assert 0 < len(forms) <= MOST_CANDIDATES
        assert len(set(forms)) == len(forms)
        assert forms == [canonical_text(read_form(form)) for form in forms]


def test_the_grammar_comes_first_and_neighbours_follow(said):
    assert candidates_for(said[1])[0].sources == ("grammar", "nearest utterance")
    assert candidates_for(said[0])[0].form == FIND


def test_a_parser_stands_before_the_neighbours_and_writes_no_nonsense(said):
    for rank, form in enumerate(["( go", GO, "UNKNOWN"], start=1):
        Proposal.objects.create(
            utterance=said[0], source="ranker", run=7, rank=rank, form=form, score=0
        )
    first = candidates_for(said[0])[0]
    assert first.form == GO
    assert "( go" not in [each.form for each in candidates_for(said[0])]


def test_labelled_utterances_are_neighbours_of_later_ones(sample, annotator):
    collect(sample.world, ["hoover up", "hoover down"])
    first, second = sample.world.utterances.order_by("pk")
    assert candidates_for(second) == ()
    label(first, Verdict.FORM, "(hoover)", annotator, 1)
    assert [each.form for each in candidates_for(second)] == ["( hoover )"]


def test_labelled_utterances_enter_new_splits(sample, said, annotator):
    label(said[0], Verdict.FORM, FIND, annotator, 1)
    said_in = [each for each in plan_split(sample.world) if each.source == "said"]
    assert [(each.utterance, each.logical_form) for each in said_in] == [(said[0].text, FIND)]


def test_a_job_stores_what_the_best_run_answers(transactional_db, world, split, settings, tmp_path):
    settings.VAR_DIR = tmp_path
    collect(world, ["go to the <room>"])
    train(claim_of(split))  # asks for the answers of the new parser
    collect(world, ["go to the <room> please"])
    done = carry_out_next()
    assert done.report == {"proposed": 2, "parser": "knn", "run": world.runs.get().pk}
    assert Proposal.objects.filter(rank=1, form__startswith="( ").count() == 2
    assert carry_out_again(world).report["proposed"] == 0


class Counting(Unwatched):
    """Notes the most statements that one of its transactions had."""

    most = 0

    @contextmanager
    def writing(self):
        with CaptureQueriesContext(connection) as statements, super().writing():
            yield
        self.most = max(self.most, len(statements))


def test_comparing_many_utterances_keeps_nobody_from_writing(sample):
    def most_of(texts: list[str]) -> int:
        collect(sample.world, texts)
        rows = list(sample.world.utterances.filter(text__in=texts).order_by("pk"))
        for number, row in enumerate(rows):
            Proposal.objects.create(
                utterance=row, source="knn", run=1, rank=1, form=GO, score=number
            )
        progress = Counting()
        enqueue_doubts(sample.world, rows, progress)
        return progress.most

    few = most_of([f"kindly find tea {number}" for number in range(10)])
    assert most_of([f"please find tea {number}" for number in range(40)]) == few > 0


def test_utterances_that_are_labelled_or_deleted_meanwhile_are_not_asked_about(sample, annotator):
    collect(sample.world, ["kindly find tea", "please find tea"])
    labelled, deleted = sample.world.utterances.order_by("pk")
    for row in (labelled, deleted):
        Proposal.objects.create(utterance=row, source="knn", run=1, rank=1, form=GO, score=1)

    class Meanwhile(Unwatched):
        def writing(self):
            if deleted.pk:
                label(labelled, Verdict.FORM, FIND, annotator, 1)
                deleted.delete()
            return super().writing()

    assert enqueue_doubts(sample.world, [labelled, deleted], Meanwhile()) == 0


def test_without_a_trained_parser_the_report_says_so(transactional_db, world):
    collect(world, ["go home"])
    assert "home" in carry_out_next().report["sentence"]


def claim_of(split):
    return lifecycle.claim("a worker", "quick", ask(split, train_sources="gen"))


def carry_out_next() -> Job:
    waiting = Job.objects.queued().filter(kind=JobKind.PROPOSE).last()
    job = background.claim("a worker", "quick", Job, waiting)
    carry_out(job)
    job.refresh_from_db()
    return job


def carry_out_again(world) -> Job:
    request_proposals(world)
    return carry_out_next()


def test_what_parsers_are_unsure_of_comes_first(sample):
    texts = [f"kindly find tea {number}" for number in range(20)]
    collect(sample.world, [*texts, "go to the kitchen"])
    rows = list(sample.world.utterances.order_by("pk"))
    for number, row in enumerate(rows):
        form = GO if number in (3, 20) else FIND
        Proposal.objects.create(utterance=row, source="knn", run=1, rank=1, form=form, score=number)
    assert enqueue_doubts(sample.world, rows, UNWATCHED) == 3
    assert [(item.kind, item.utterance) for item in sample.world.work_items.open()] == [
        ("disagreement", rows[3]),
        ("low_confidence", rows[0]),
        ("low_confidence", rows[1]),
    ]
    assert enqueue_doubts(sample.world, rows, UNWATCHED) == 0
