"""The tutorial of the greenhouse, done as it says on an installation that has no world yet."""

from __future__ import annotations

from pathlib import Path

import pytest

from annotations.models import World
from tests.browser.tutorial import Follower
from tests.parser_service.live_server import parse_server  # noqa: F401

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

GUIDES = Path(__file__).parents[3] / "docs" / "guides"
MOST_CLICKS = 30
MOST_PICTURES = 5


def test_the_tutorial_leads_from_nothing_to_a_plan(superuser, logged_in, live_server, parse_server):  # noqa: F811
    page = logged_in(superuser).new_page()
    page.goto(live_server.url)
    pictures: list[str] = []
    effort = Follower(page, parse_server.update, pictures.append).follow(GUIDES / "greenhouse.md")
    print(effort)
    assert effort.clicks <= MOST_CLICKS and 0 < len(pictures) <= MOST_PICTURES

    world = World.objects.get(name="greenhouse")
    assert set(world.entity_classes.values_list("token", flat=True)) == {"plant", "bed", "place"}
    assert set(world.predicates.values_list("name", flat=True)) == {"water", "go", "carry", "prune"}
    assert world.utterances.count() == 12
    steps = page.locator("#playground-answer .plan-steps code").all_inner_texts()
    assert [each for each in steps if "(" in each] == ["water(tomatoes, bed two)"]


def test_the_same_world_is_made_by_hand(superuser, logged_in, live_server, parse_server):  # noqa: F811
    page = logged_in(superuser).new_page()
    page.goto(live_server.url)
    effort = Follower(page, parse_server.update).follow(GUIDES / "by-hand.md", "On the pages")
    print(effort)
    assert effort.clicks <= 2 * MOST_CLICKS
    world = World.objects.get(name="by-hand")
    assert set(world.entity_classes.values_list("token", flat=True)) == {"plant", "bed"}
    steps = page.locator("#playground-answer .plan-steps code").all_inner_texts()
    assert [each for each in steps if "(" in each] == ["water(tomatoes, bed two)"]
