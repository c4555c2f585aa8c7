"""Everything that a page can do, the API can do: a page that does more needs a route, or a reason."""

from __future__ import annotations

from tests.gpsr_site.routes.listing import ALL_ROUTES, API_ROUTES
from tests.gpsr_site.routes.page_actions import PAGE_ACTIONS, PAGE_VIEWS, NoRoute, routes_of
from tests.gpsr_site.routes.policy import POLICY


def test_every_page_that_is_posted_to_has_a_line():
    posted = {rule.name for rule in POLICY if rule.method == "post"} - set(API_ROUTES)
    assert set(PAGE_ACTIONS) == posted


def test_every_other_page_has_a_line():
    assert set(PAGE_VIEWS) == set(ALL_ROUTES) - set(API_ROUTES) - set(PAGE_ACTIONS)


def test_the_routes_are_there():
    there = {(rule.name, rule.method) for rule in POLICY}
    every = [*PAGE_ACTIONS.values(), *PAGE_VIEWS.values()]
    lines = [each for each in every if not isinstance(each, NoRoute)]
    assert {route for line in lines for route in routes_of(line)} <= there


# Pages whose people are others in the policy, though the rule behind both is one.
EXPLAINED = {
    "session_end": "A log-in that is not there is a 404 of the API; the page goes on.",
    "label_check": "The route checks labels of paraphrases too, which reviewers correct.",
    "analysis_cancel": "What stopping a job needs is the job's own; the policy asks for another kind.",
    "promotion_promote": "The page is sent no run, which is a 404; the route misses its body.",
}


def test_a_route_is_allowed_to_the_people_of_its_page():
    """Whom the page refuses the route refuses, and nobody else."""
    refused = {(rule.name, rule.method): refusals_of(rule) for rule in POLICY}
    different = set()
    for page, line in PAGE_ACTIONS.items():
        if not isinstance(line, NoRoute):
            people = {refused[route] for route in routes_of(line)}
            if refused[page, "post"] not in people:
                different.add(page)
    assert different == set(EXPLAINED)


def refusals_of(rule) -> frozenset[str]:
    """Return who may not do it at all: the anonymous are sent to log in, or told to bring a token."""
    people = ("stranger", "annotator", "reviewer", "admin")
    return frozenset(person for person in people if getattr(rule, person) in (403, 404))
