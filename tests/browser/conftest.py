"""A browser, a server with a sample world, and somebody logged in."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from django.test import Client
from playwright.sync_api import Browser, BrowserContext, Page, expect

from annotations.models import User
from parser_service.runs import run_requests
from tests.browser.chromium import CHROMIUM, FIREFOX, FIREFOX_MISSING, MISSING
from tests.browser.faults import AXE
from tests.browser.variants import Variant
from tests.parser_service.worker_process import RunningWorker
from tests.sample_world import SampleWorld, fill_world
from tests.waiting import PATIENCE_SECONDS

# Playwright keeps an event loop in this thread, in which Django would refuse to ask its database.
os.environ["DJANGO_ALLOW_ASYNC_UNSAFE"] = "true"

expect.set_options(timeout=PATIENCE_SECONDS * 1000)

BUNDLE = Path(__file__).resolve().parents[2] / "static" / "dist" / "main.js"


@pytest.fixture(scope="session")
def browser_type_launch_args(browser_name: str) -> dict[str, object]:
    """The machine's Chromium, or Firefox with ``--browser firefox``; the tests are skipped without it or without the
    built front end."""
    if not BUNDLE.exists():
        pytest.skip("needs the built front end: make install")
    if browser_name == "firefox":
        if not FIREFOX:
            pytest.skip(FIREFOX_MISSING)
        return {"executable_path": FIREFOX, "channel": "moz-firefox"}
    if not CHROMIUM:
        pytest.skip(MISSING)
    return {"executable_path": CHROMIUM, "args": ["--no-sandbox"]}


@pytest.fixture
def sample(transactional_db, world) -> SampleWorld:
    return fill_world(world)


def give_window(context: BrowserContext, user: User, url: str) -> None:
    """Log ``user`` in, in place of whoever was."""
    client = Client()
    client.force_login(user)
    value = client.cookies["sessionid"].value
    context.add_cookies([{"name": "sessionid", "value": value, "url": url}])


@pytest.fixture
def logged_in(browser: Browser, live_server) -> Iterator[Callable[..., BrowserContext]]:
    """Makes browser windows in which somebody, or nobody, is logged in already."""
    made: list[BrowserContext] = []

    def log_in(
        user: User | None, variant: Variant | None = None, **options: object
    ) -> BrowserContext:
        context = browser.new_context(**(variant.options if variant else {}), **options)
        if user:
            give_window(context, user, live_server.url)
        context.set_default_timeout(PATIENCE_SECONDS * 1000)
        made.append(context)
        return context

    yield log_in
    for context in made:
        context.close()


@pytest.fixture(scope="session")
def axe() -> str:
    """The source of axe-core; the tests are skipped without it."""
    if not AXE.exists():
        pytest.skip(f"needs axe-core, and there is none at {AXE.parent}: make install")
    return AXE.read_text(encoding="utf-8")


@pytest.fixture
def page_of(logged_in, sample) -> Callable[..., Page]:
    """A page in such a window."""
    return lambda user, **options: logged_in(user, **options).new_page()


@pytest.fixture
def worker(sample, tmp_path) -> Iterator[RunningWorker]:
    """A real worker on the filesystem broker."""
    started = RunningWorker(tmp_path / "worker.log")
    yield started
    started.remove()
    print(started.log.read_text(encoding="utf-8"))


@pytest.fixture
def waiting_run(sample):
    """A run that nobody has begun."""
    return run_requests.request(sample.world, sample.split, "seq2seq", send=False)[0]


@pytest.fixture
def page_without_login(logged_in) -> Page:
    """A page in the window of somebody who has no account."""
    return logged_in(None).new_page()
