"""Start a run: its button is always in view. Two runs: ticked and compared with three clicks."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import expect

from annotations.models import Split
from tests.parser_service.made_up import make_split
from tests.parser_service.web.results.test_result_pages import by_form
from tests.sample_world import scored_run

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


@pytest.mark.parametrize("size", [(1280, 800), (640, 400), (390, 844)], ids=str)
def test_the_button_is_always_in_view(size, page_of, live_server, sample, admin):
    Split.objects.update(
        name="a-very-long-name-of-a-split-that-somebody-has-chosen-by-form-and-more"
    )
    page = page_of(admin)
    page.set_viewport_size({"width": size[0], "height": size[1]})
    page.goto(f"{live_server.url}/w/home/runs/new/")
    button = page.get_by_role("button", name="Start the run")
    for y in (0, 300, 100_000):
        page.evaluate(f"window.scrollTo(0, {y})")
        box = button.bounding_box()
        assert box["y"] >= 0 and box["y"] + box["height"] <= size[1], y
        # Nothing lies over it.
        centre = [box["x"] + box["width"] / 2, box["y"] + box["height"] / 2]
        on_top = page.evaluate("([x, y]) => document.elementFromPoint(x, y).textContent", centre)
        assert on_top.strip() == "Start the run"


def test_what_has_the_focus_is_never_below_the_button(page_of, live_server, sample, admin):
    page = page_of(admin)
    page.set_viewport_size({"width": 640, "height": 400})
    page.goto(f"{live_server.url}/w/home/runs/new/?parser=seq2seq")
    bar = page.locator(".run-start")
    for name in ("split", "seeds", "share"):
        field = page.locator(f"[name={name}]")
        field.focus()
        box = field.bounding_box()
        assert box["y"] + box["height"] <= bar.bounding_box()["y"], name


def test_the_note_follows_the_chosen_split(page_of, live_server, sample, admin):
    other = make_split(sample.world, "second")
    Split.objects.filter(pk=sample.split.pk).update(name="first")
    page = page_of(admin)
    page.goto(f"{live_server.url}/w/home/runs/new/?parser=seq2seq&split={sample.split.pk}")
    page.get_by_label("Seeds").fill("3")
    page.get_by_label("Split").select_option(str(other.pk))
    expect(page.locator("#split-contents")).to_contain_text("24 generated commands")
    expect(page.get_by_label("Seeds")).to_have_value("3")


def test_what_is_chosen_while_another_split_is_looked_up_stays(page_of, live_server, sample, admin):
    other = make_split(sample.world, "second")
    page = page_of(admin)
    page.goto(f"{live_server.url}/w/home/runs/new/?parser=seq2seq&split={sample.split.pk}")
    held = []
    page.route(f"**/runs/new/?*split={other.pk}*", lambda route: held.append(route))
    page.get_by_label("Split").select_option(str(other.pk))
    page.wait_for_function("document.querySelector('.htmx-request')")
    page.get_by_label("Seeds").fill("3")
    held[0].continue_()
    expect(page.locator("#split-contents")).to_contain_text("24 generated commands")
    expect(page.get_by_label("Seeds")).to_have_value("3")
    expect(page.locator("#run-start-about")).to_contain_text("second")


@pytest.mark.parametrize("path", ["runs/", "results/?part=validation"])
def test_two_ticked_runs_are_compared_with_three_clicks(path, page_of, live_server, sample, admin):
    other = scored_run(sample.world, sample.split, "seq2seq", seed=1)
    page = page_of(admin)
    page.goto(f"{live_server.url}/w/home/{path}")
    for run in (sample.run, other):
        page.locator(f"input[name=run][value='{run.pk}']").first.check()
    page.get_by_role("button", name="Compare the ticked runs").click()
    expect(page).to_have_url(re.compile(r"/compare/\?"))
    for run in (sample.run, other):
        assert f"run={run.pk}" in page.url
        expect(page.locator(f"#run-{run.pk}")).to_be_checked()


def test_the_evidence_of_a_candidate_is_in_the_window(page_of, live_server, sample, admin):
    by_form(sample)
    Split.objects.update(name="walker2019-by-logical_form-and-what-a-team-adds-to-a-name")
    page = page_of(admin)
    page.goto(f"{live_server.url}/w/home/promotion/")
    table = page.locator(".candidates-table")
    assert table.evaluate("each => each.scrollWidth - each.parentElement.clientWidth") <= 0
    box = table.get_by_text("Evidence").last.bounding_box()
    assert box["x"] + box["width"] <= 1280


def test_a_tick_survives_the_refreshing_of_the_table(page_of, live_server, sample, admin):
    page = page_of(admin)
    page.goto(f"{live_server.url}/w/home/runs/")
    tick = page.locator("input[name=run]").first
    tick.check()
    with page.expect_response(lambda answer: "runs/table" in answer.url):
        scored_run(sample.world, sample.split, "seq2seq", seed=2)
    expect(page.locator("#runs-table tbody tr")).to_have_count(2)
    expect(page.locator("input[name=run]:checked")).to_have_count(1)


def test_the_legend_shows_on_focus(page_of, live_server, sample, admin):
    page = page_of(admin)
    page.goto(f"{live_server.url}/w/home/results/")
    legend = page.get_by_role("tooltip")
    expect(legend).to_have_count(0)
    page.get_by_role("button", name="How to read this").focus()
    expect(legend).to_be_visible()
