"""Every page in both widths and themes: no error, nothing unnamed, nothing beside the screen."""

from __future__ import annotations

import pytest
from playwright.sync_api import Page

from annotations.labelling import collect
from annotations.models import Entity
from annotations.queueing import refill
from tests.browser.screenshots import PAGES
from tests.browser.variants import VARIANTS
from tests.sample_world import SampleWorld, comment_in

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

SETTLE = 150  # milliseconds for modules, charts and the first fragments

# Visible elements that one can use, and that have no name to call them by.
NAMELESS = """() => {
  const named = (element) => [
    element.getAttribute("aria-label"),
    element.title,
    element.innerText,
    ...[...(element.labels ?? [])].map((label) => label.textContent),
    document.getElementById(element.getAttribute("aria-labelledby") ?? "")?.textContent,
    element.querySelector?.("svg[aria-label], img[alt]") ? "drawn" : "",
  ].some((text) => text?.trim());
  return [...document.querySelectorAll("a[href], button, input, select, textarea, summary")]
    .filter((element) => element.type !== "hidden" && !named(element))
    .filter((element) => element.checkVisibility({visibilityProperty: true}))
    .map((element) => element.outerHTML.slice(0, 160));
}"""
TWICE = """() => {
  const ids = [...document.querySelectorAll("[id]")].map((element) => element.id);
  return ids.filter((id, place) => ids.indexOf(id) !== place);
}"""
BESIDE = """() => {
  const width = document.documentElement.clientWidth;
  if (document.documentElement.scrollWidth <= width) return [];
  return [...document.querySelectorAll("main *")]
    .filter((element) => element.getBoundingClientRect().right > width + 1)
    .map((element) => element.outerHTML.slice(0, 120)).slice(0, 3);
}"""


def addresses(sample: SampleWorld) -> list[str]:
    """Every page there is about the sample world."""
    run = f"runs/{sample.run.pk}"
    collect(sample.world, ["bring me the tea"])
    refill(sample.world)
    about = [
        f"templates/{sample.template.pk}/",
        f"grammar/{sample.world.grammar.productions.first().pk}/",
        f"predicates/{sample.world.predicates.first().pk}/",
        f"rename/production/{sample.world.grammar.productions.first().pk}/?new=verb&old=vbfind",
        f"comments/production/{sample.world.grammar.productions.first().pk}/",
        f"comments/{comment_in(sample.world).pk}/",
        f"history/template/{sample.template.pk}/",
        f"forms/{sample.form.pk}/",
        f"splits/{sample.split.pk}/",
        f"splits/{sample.split.pk}/examples/{sample.example.pk}/",
        f"commands/{sample.world.commands.first().pk}/",
        f"ontology/{Entity.objects.filter(ontology__world=sample.world).first().pk}/",
        f"utterances/{sample.world.utterances.get().pk}/",
        f"queue/{sample.world.work_items.get().pk}/",
        f"{run}/",
        f"{run}/predictions/",
        f"{run}/predictions/{sample.example.pk}/",
    ]
    return [
        "/",
        "/inbox/",
        "/password/",
        *(f"/w/home/{path}" for path in [*PAGES.values(), *about]),
    ]


def listen(page: Page) -> list[str]:
    """What the page complains of, scripts refused by its policy included."""
    complaints: list[str] = []
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.on(
        "console",
        lambda message: message.type in ("error", "warning") and complaints.append(message.text),
    )
    page.on(
        "response",
        lambda answer: answer.status >= 400 and complaints.append(f"{answer.status} {answer.url}"),
    )
    return complaints


@pytest.mark.parametrize("variant", VARIANTS, ids=str)
def test_every_page_is_whole(variant, sample, waiting_run, admin, page_of, live_server):
    page = page_of(admin, variant=variant)
    complaints = listen(page)
    for path in [*addresses(sample), f"/w/home/runs/{waiting_run.pk}/"]:
        page.goto(f"{live_server.url}{path}")
        page.wait_for_load_state("load")
        page.wait_for_timeout(SETTLE)
        faults = {
            "complaints": list(complaints),
            "without a name": page.evaluate(NAMELESS),
            "ids given twice": page.evaluate(TWICE),
            "beside the screen": page.evaluate(BESIDE),
        }
        assert not any(faults.values()), f"{path}: {faults}"
        assert page.locator("h1").count() == 1, path
        assert page.locator("html").get_attribute("lang") == "en"


def test_no_page_is_wider_than_its_window(sample, admin, page_of, live_server):
    """Also between the usual widths: 640 is a window of 1280 at a zoom of 200 %."""
    page = page_of(admin)
    for path in addresses(sample):
        page.goto(f"{live_server.url}{path}")
        for width in (320, 640, 820, 1000, 1200):
            page.set_viewport_size({"width": width, "height": 600})
            assert settled(page, BESIDE) == [], f"{path} at {width}"


def settled(page, faults):
    """What ``faults`` lists once nothing is left, or after 10 s: a chart takes its new width late."""
    for _ in range(100):
        if not page.evaluate(faults):
            break
        page.wait_for_timeout(100)
    return page.evaluate(faults)


def test_the_log_in_page_is_whole(page, live_server, db):
    complaints = listen(page)
    page.goto(f"{live_server.url}/login/")
    assert page.evaluate(NAMELESS) == []
    assert complaints == []
