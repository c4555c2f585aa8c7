"""The slider over bounds, and trying a text, by keyboard."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import expect

from annotations.background.progress import UNWATCHED
from annotations.models import Job, JobKind
from parser_service.models import Tryout
from parser_service.reviews.analysis_job import OF_PARTS
from parser_service.reviews.stored_findings import keep_finding
from parser_service.reviews.target import Target
from parser_service.reviews.tryout_answers import answer_jobs
from tests.filled_world import save_parser
from tests.parser_service.reviews.analyses.conftest import done
from tests.parser_service.served import name_umbrella
from tests.waiting import wait_for

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


def test_the_slider_says_what_refusing_saves_and_the_address_keeps_it(
    page_of, live_server, sample, reviewer
):
    target = Target(sample.run, "validation")
    for step in OF_PARTS:
        keep_finding(sample.run, "validation", step.name, step.find(target, UNWATCHED), UNWATCHED)
    page = page_of(reviewer)
    page.goto(f"{live_server.url}/w/home/runs/{sample.run.pk}/defaults/")
    panel = page.locator("[data-refusal][data-ready]")
    expect(panel).to_contain_text("Everything is answered")
    page.get_by_label("Answer UNKNOWN below a score of").focus()
    page.keyboard.press("End")
    expect(panel).to_contain_text("Answering UNKNOWN to everything withholds")
    page.keyboard.press("Home")
    expect(panel).to_contain_text("Everything is answered")
    expect(page).to_have_url(re.compile(r"bound=0\.5$"))


def test_a_text_of_the_paper_is_one_click_away_and_its_answer_follows(
    page_of, live_server, sample, reviewer, settings
):
    settings.WORK_TEMPO = 10_000
    save_parser(sample.run)
    name_umbrella(sample.world)
    page = page_of(reviewer)
    page.goto(f"{live_server.url}/w/home/parse/?beside={sample.run.pk}")
    expect(page.locator("#beside-answers")).to_contain_text("Type a text")
    page.locator(".suggestion", has_text="Bring an umbrella to me").click()
    expect(page.locator("#playground-text")).to_have_value("Bring an umbrella to me")
    expect(page.locator("#beside-answers")).to_contain_text("waiting for the answer")
    expect(page).to_have_url(re.compile(r"text=Bring\+an\+umbrella\+to\+me"))
    wait_for(lambda: answer_jobs(sample.world).exists(), "the job is asked for")
    done(answer_jobs(sample.world).get())
    expect(page.locator("#beside-answers .lf").first).to_be_visible()
    assert Tryout.objects.get().is_answered
    assert Job.objects.filter(kind=JobKind.ANSWER).count() == 1
