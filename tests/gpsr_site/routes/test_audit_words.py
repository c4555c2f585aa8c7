"""Every page says what it does, for the audit log."""

from __future__ import annotations

import re

import pytest
from django.core.exceptions import ImproperlyConfigured

from annotations.models import Duty
from annotations.people.access import (
    NOTHING,
    READ,
    READ_AND_WRITE,
    WRITE,
    plain_view,
    site_view,
    world_view,
)
from annotations.web.worlds.job_pages import job_view
from tests.gpsr_site.routes.listing import API_ROUTES, VIEWS
from tests.gpsr_site.routes.policy import POLICY

# Page → what a POST to it does: empty where it takes none, None where it declares nothing.
SAID = {name: getattr(VIEWS[name], "does", None) for name in VIEWS.keys() - API_ROUTES.keys()}
POSTED = {rule.name for rule in POLICY if rule.method == "post"} - API_ROUTES.keys()
ONLY_CHECKS = re.compile("_(check|preview|suggestions|consequences)$")
UNRECORDED = {
    # What one person alone sees
    *("draft", "inbox", "notice_open", "queue_next", "first_steps", "compare_baseline"),
    *("playground_ask", "beside_ask", "joint_plan_ask", "try_examples"),
    # Contributors are known by a pseudonym alone, also where they are logged in
    *("campaign", "campaign_place", "campaign_done"),
}
UNRECORDED_ROUTES = {"api:notice-read", "api:notice-read-all", "api:work-item-next"}


def test_every_page_declares_what_it_does():
    assert [name for name, said in SAID.items() if said is None] == []
    assert {name for name, said in SAID.items() if said} == POSTED


def test_nothing_is_left_out_of_the_log_but_what_others_do_not_see():
    left_out = {name for name, said in SAID.items() if said == NOTHING}
    assert {name for name in left_out if not ONLY_CHECKS.search(name)} == UNRECORDED
    assert {name for name in POSTED if ONLY_CHECKS.search(name)} <= left_out
    routes = {
        name
        for name, route in API_ROUTES.items()
        for method in route.methods
        if route.asked(method) in getattr(route.view, "unrecorded", ())
    }
    assert routes == UNRECORDED_ROUTES


@pytest.mark.parametrize(
    "declare",
    [
        lambda: plain_view(WRITE),
        lambda: plain_view(READ, does="log in"),
        lambda: world_view(Duty.VIEW, READ_AND_WRITE, write_duty=Duty.MANAGE),
        lambda: site_view(WRITE),
        lambda: job_view(WRITE),
    ],
)
def test_a_page_that_is_posted_to_and_says_nothing_is_refused_at_once(declare):
    with pytest.raises(ImproperlyConfigured, match="says what it does"):
        declare()(lambda request: None)
