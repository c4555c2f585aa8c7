"""The page that says which run answers, and lets an admin change it."""

from __future__ import annotations

import pytest

from parser_service.models import Promotion
from parser_service.runs.checkpoints import model_folder, remove_folder
from parser_service.runs.promoting import promote, promoted_run
from tests.notices import levels
from tests.parser_service.live_server import parse_server  # noqa: F401
from tests.parser_service.served import make_home, trained_run

PAGE = "/w/home/promotion/"


@pytest.fixture
def split(world):
    return make_home(world)


@pytest.fixture
def runs(split):
    """The promoted run, and a better one."""
    first = trained_run(split)
    promote(first, None, "The first.")
    return first, trained_run(split, seed=1, spoken=0.625)


def test_the_evidence_of_both_stands_beside_each_other(runs, adam):
    first, better = runs
    page = adam.get(PAGE, {"run": better.pk})
    shown = " ".join(page.content.decode().split())
    assert page.context["chosen"] == better
    assert "62.5 <span" in shown and "50.0 <span" in shown and "+12.5" in shown
    assert f"/compare/?run={first.pk}&amp;run={better.pk}" in shown


def test_the_page_of_a_run_leads_there_or_says_that_it_answers(runs, adam, anna):
    first, better = runs
    link = f'href="{PAGE}?run={better.pk}"'
    assert link in adam.get(f"/w/home/runs/{better.pk}/").content.decode()
    assert link not in anna.get(f"/w/home/runs/{better.pk}/").content.decode()
    present = adam.get(f"/w/home/runs/{first.pk}/").content.decode()
    main = present.partition('<main id="main"')[2]
    assert f'href="{PAGE}"' in main and f"{PAGE}?run=" not in main


def test_an_admin_promotes_and_rolls_back_with_reasons(runs, adam, world):
    first, better = runs
    adam.post(f"{PAGE}promote/", {"run": better.pk, "reason": "better on names"})
    assert promoted_run(world) == better
    page = adam.get(PAGE).content.decode()
    assert "better on names" in page
    assert f'action="{PAGE}roll-back/"' in page and f"run {first.pk}<" in page
    adam.post(f"{PAGE}roll-back/")
    assert promoted_run(world) == first
    newest = adam.get(PAGE).context["history"][0]
    assert (newest.run, newest.state) == (first, "promoted") and newest.reason


def test_others_see_it_and_cannot_change_it(runs, anna, rene, world):
    first, better = runs
    for client in (anna, rene):
        page = client.get(PAGE, {"run": better.pk}).content.decode()
        assert "/promote/" not in page and "/roll-back/" not in page
        assert f"/w/home/runs/{better.pk}/" in page
        assert client.post(f"{PAGE}promote/", {"run": better.pk}).status_code == 403
    assert promoted_run(world) == first


def test_a_proposal_is_shown_counted_and_decided(runs, adam, world):
    _, better = runs
    row = Promotion.objects.create(
        world=world, run=better, state="proposed", reason="The corpus changed."
    )
    page = adam.get(PAGE)
    assert "The corpus changed." in page.content.decode()
    (entry,) = [each for each in page.context["tabs"] if each.label == "Promotion"]
    assert entry.dot.startswith("1 run ")
    assert entry.dot in adam.get("/w/home/").content.decode()
    adam.post(f"{PAGE}{row.pk}/decline/")
    again = adam.post(f"{PAGE}{row.pk}/decline/", follow=True)
    assert levels(again) == ["error"] and not again.context["proposals"]


def test_what_cannot_be_promoted_is_a_sentence(runs, adam, other_world):
    first, _ = runs
    answer = adam.post(f"{PAGE}promote/", {"run": first.pk}, follow=True)
    assert levels(answer) == ["error"] and f" {first.pk} " in str(*answer.context["messages"])
    assert adam.post(f"{PAGE}promote/", {"run": "x"}).status_code == 404


def test_a_parser_that_the_server_could_not_load_is_told(runs, adam, parse_server):  # noqa: F811
    first, better = runs
    parse_server.update()
    promote(better, None)
    remove_folder(model_folder(better.pk))
    parse_server.update()
    state = adam.get("/w/home/parse/state/")
    page = state.content.decode()
    assert (state.context["held"]["run"], state.context["promoted"]) == (first.pk, better)
    assert state.context["held"]["problem"] in page
    assert f"Run {first.pk} " in page and f"run {better.pk} " in page


def test_an_empty_world_says_what_will_happen(world, anna):
    page = anna.get(PAGE)
    assert page.context["present"] is None
    assert '<div class="empty">' in page.content.decode()
