"""What contributors wrote is read by the best parser: a flag where it is sure of another form than the prompt's."""

from __future__ import annotations

import pytest

from annotations.background.progress import UNWATCHED
from annotations.campaigns.answering import finish, save_answer
from annotations.campaigns.moderation import mend
from annotations.labelling.proposal_requests import request_readings
from annotations.models import Job, JobKind
from parser_service.labelling.submission_readings import read_submissions, score_of_sure_answers
from parser_service.models import Prediction
from parser_service.parsers.interface import Pair
from parser_service.parsers.knn import NearestNeighbour
from tests.launched_campaigns import small_campaign
from tests.parser_service.requests import ask

FIRST, SECOND, OTHER = "( go 1 )", "( go 2 )", "( go 3 )"
BOUND = 0.8


@pytest.fixture
def run(split):
    """A run that was right on what people said with a score of ``BOUND`` and above, and wrong below."""
    made = ask(split, train_sources="para")
    examples = split.examples.filter(source="paraphrased")
    examples.update(part="validation")
    examples.filter(position=0).update(part="train")
    for number, example in enumerate(examples.filter(part="validation")):
        is_right = number < 25
        Prediction.objects.create(
            run=made,
            example=example,
            rank=1,
            logical_form=example.logical_form,
            score=BOUND if is_right else BOUND / 2,
            is_exact_match=is_right,
            is_equivalent=is_right,
            is_well_formed=True,
        )
    return made


@pytest.fixture
def parser():
    """Knows three texts, and gives the more another one shares with them the higher its score."""
    trained = NearestNeighbour()
    texts = (("fetch the apple for me", FIRST), ("count the people", SECOND), ("do a dance", OTHER))
    trained.fit([Pair(text, form) for text, form in texts])
    return trained


@pytest.fixture
def submissions(world):
    campaign = small_campaign(world)
    contributor = campaign.contributors.create(pseudonym="somebody")
    prompts = list(campaign.prompts.order_by("position"))
    texts = (
        "fetch the apple for me",
        "do a dance",
        "do whatever you like",
        "fetch the apple for me",
    )
    return [
        contributor.submissions.create(
            position=number,
            kind="rewrite",
            prompt=prompts[number % 2],
            text=text,
            flags=[{"code": "pasted", "evidence": ""}],
        )
        for number, text in enumerate(texts)
    ]


def flags_of(rows):
    for row in rows:
        row.refresh_from_db()
    return [[(flag["code"], flag["evidence"]) for flag in row.flags] for row in rows]


def test_the_bound_is_where_answers_are_right_no_more(run):
    assert score_of_sure_answers(run) == BOUND
    run.predictions.filter(score=BOUND).order_by("pk").first().delete()
    run.predictions.exclude(score=BOUND).delete()
    assert score_of_sure_answers(run) == BOUND
    run.predictions.filter(pk__in=run.predictions.values("pk")[:6]).delete()
    assert score_of_sure_answers(run) is None  # too few


def test_what_reads_as_another_form_gets_a_flag_with_it(world, run, parser, submissions):
    report = read_submissions(world, run, parser, UNWATCHED)
    pasted = ("pasted", "")
    assert flags_of(submissions) == [
        [pasted],  # reads as its own form
        [pasted, ("other_form", OTHER)],
        [pasted],  # the parser is not sure
        [pasted, ("other_form", FIRST)],
    ]
    assert report == {"read": 4, "flagged": 2}
    again = read_submissions(world, run, parser, UNWATCHED)
    assert again == {}


def test_what_the_run_has_learned_from_is_not_asked(world, run, parser, submissions):
    run.split.examples.filter(part="train").update(utterance="do a dance")
    read_submissions(world, run, parser, UNWATCHED)
    assert flags_of(submissions)[1] == [("pasted", "")]


def test_a_text_that_is_mended_is_read_again(world, run, parser, submissions):
    read_submissions(world, run, parser, UNWATCHED)
    mend(submissions[1], "do a dancee")
    assert flags_of(submissions)[1] == [("pasted", ""), ("lost_entity", "living room")]
    assert read_submissions(world, run, parser, UNWATCHED)["read"] == 1


def test_decisions_that_fall_meanwhile_stay(world, run, parser, submissions):
    class Meanwhile(type(UNWATCHED)):
        def writing(self):
            submissions[1].status = "accepted"
            submissions[1].save()
            return super().writing()

    read_submissions(world, run, parser, Meanwhile())
    assert flags_of(submissions)[1] == [("pasted", "")]


def test_who_finishes_a_task_has_it_read_where_a_parser_could(world, split, submissions):
    contributor = submissions[0].contributor
    asked = Job.objects.filter(kind=JobKind.PROPOSE)
    assert request_readings(world) is None
    run = ask(split, train_sources="para")
    run.status = "succeeded"
    run.save()
    finish(contributor, had_model_help=False)
    assert asked.count() == 1
    assert request_readings(world) is None  # one at a time


def test_a_changed_answer_is_read_again(world, submissions):
    submissions[0].read_by_run = 7
    submissions[0].save()
    assert save_answer(submissions[0], "bring the apple").read_by_run is None
