"""Every page in a narrow dark window, a wide light one, between and on paper: whole, and to be used by everybody."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import pytest
from django.http.response import HttpResponseBase
from django.test import Client
from django.urls import resolve
from playwright.sync_api import Page

from annotations.models import User
from tests.browser.faults import (
    OF_WIDTH,
    Faults,
    in_place,
    listen,
    look_for,
    narrow_and_dark,
    only_faults,
    printed,
    wide_and_light,
)
from tests.browser.screenshots import PAGES
from tests.browser.tree import tree_faults
from tests.browser.variants import NARROW_DARK, WIDE_LIGHT
from tests.filled_world import leave_traces
from tests.gpsr_site.routes.addresses import address
from tests.gpsr_site.routes.policy import POLICY, YES
from tests.sample_world import SampleWorld

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

# Open what a page folds away, and say how much that was.
OPEN_ALL = """() => [...document.querySelectorAll("main details:not([open])")]
  .map((each) => { each.open = true; }).length"""
WIDTHS = (1200, 1000, 820, 768, 640, 360, 320)  # 640 is a window of 1280 at a zoom of 200 %


@pytest.fixture
def filled(sample, annotator, admin) -> SampleWorld:
    """The sample world after people have worked in it; ``admin`` looks after the whole site."""
    leave_traces(sample.world, annotator, admin)
    User.objects.filter(pk=admin.pk).update(is_superuser=True)
    return replace(sample, form=sample.world.logical_forms.first())


def addresses(sample: SampleWorld, client: Client) -> list[str]:
    """Every page that ``client``, an admin, can read about the filled world: some chosen rows, then all
    other routes that answer with a page."""
    world = sample.world
    production, items = world.grammar.productions.first().pk, world.work_items
    about = [
        f"rename/production/{production}/?new=verb&old=vbfind",
        f"comments/production/{production}/",
        f"history/template/{sample.template.pk}/",
        *(f"queue/{items.filter(kind=kind).first().pk}/" for kind in ("adjudication", "disputed")),
        *("people/", "delete/"),
    ]
    chosen = [
        *("/worlds/new/", "/worlds/import/"),
        f"/jobs/{world.jobs.first().pk}/",
        *(f"/w/{world.name}/{path}" for path in [*PAGES.values(), *about]),
    ]
    names = {resolve(path.partition("?")[0]).url_name for path in chosen}
    readable = {rule.name for rule in POLICY if (rule.method, rule.admin) == ("get", YES)}
    others = [address(name, sample) for name in sorted(readable - names)]
    return chosen + [path for path in others if is_page(client.get(path))]


def is_page(answer: HttpResponseBase) -> bool:
    """Whether a browser shows ``answer`` as a page; it saves others as files."""
    return not answer.has_header("Content-Disposition") and b"<h1" in b"".join(answer)


@dataclass(frozen=True)
class Window:
    """Somebody's window, and what the pages in it complain of."""

    url: str
    page: Page
    complaints: list[str]

    def faults(self, path: str) -> Faults:
        """What is wrong with a page that is opened narrow and dark, printed, and then made wide and light."""
        page = self.page
        page.set_viewport_size(NARROW_DARK.size)
        page.emulate_media(color_scheme="dark")
        page.goto(f"{self.url}{path}", wait_until="domcontentloaded")
        report = narrow_and_dark(page)
        for width in WIDTHS:
            page.set_viewport_size({"width": width, "height": 600})
            faults = look_for(page, OF_WIDTH)
            report |= {f"{what} at {width} pixels": each for what, each in faults.items()}
        report |= printed(page)
        page.set_viewport_size(WIDE_LIGHT.size)
        page.emulate_media(color_scheme="light")
        report |= wide_and_light(page) | tree_faults(page)
        if page.evaluate(OPEN_ALL):
            opened = {**in_place(page), **tree_faults(page)}
            report |= {f"{what}, opened": each for what, each in opened.items()}
        report["complaints"] = list(self.complaints)
        self.complaints.clear()
        return report


@pytest.fixture
def window_of(logged_in, axe, live_server) -> Callable[[User | None], Window]:
    """Opens a window of somebody, or of nobody."""

    def open_window(user: User | None) -> Window:
        page = logged_in(user, variant=NARROW_DARK).new_page()
        page.add_init_script(axe)
        window = Window(live_server.url, page, [])
        listen(page, window.complaints)
        return window

    return open_window


def test_every_page_is_whole_and_can_be_used_by_everybody(
    filled, waiting_run, admin, adam, window_of
):
    window = window_of(admin)
    paths = [*addresses(filled, adam), f"/w/home/runs/{waiting_run.pk}/"]
    assert "/w/home/templates/new/" in paths and len(paths) > 60
    assert only_faults({path: window.faults(path) for path in paths}) == {}


def test_so_are_the_pages_that_say_no(sample, annotator, window_of):
    nobody, anna = window_of(None), window_of(annotator)
    for window, path, status in (
        (nobody, "/login/", None),
        (nobody, "/no-such-page/", "404"),
        (anna, "/w/home/no-such-page/", "404"),
        (anna, "/w/home/runs/new/", "403"),
    ):
        report = window.faults(path)
        refusals = [each for each in report["complaints"] if status and status in each]
        assert bool(refusals) == bool(status)
        report["complaints"] = [each for each in report["complaints"] if each not in refusals]
        assert only_faults({path: report}) == {}
