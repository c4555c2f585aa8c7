"""A team's evening before a competition: a world, its folder, its rooms, a sample, a split, a learned part.

Once through all pages with pictures of each, and once by the first steps alone, by clicks and keys.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from time import monotonic
from typing import Any
from zipfile import ZipFile

import pytest
from playwright.sync_api import Locator, Page, expect

from annotations.models import Entity, World
from parser_service.models import TrainingRun
from parser_service.parsers.registry import title_of
from tests.browser.arriving import arrive, arrive_at, wait_for_swap
from tests.browser.faults import OF_STRUCTURE, SETTLED, look_for, only_faults
from tests.browser.screenshots import log_in
from tests.browser.variants import NARROW_DARK, WIDE_LIGHT
from tests.parser_service.live_server import parse_server  # noqa: F401
from tests.parser_service.worker_process import RunningWorker
from tests.waiting import PATIENCE_SECONDS

pytestmark = [
    pytest.mark.browser,
    pytest.mark.processes,
    pytest.mark.django_db(transaction=True),
]

FOLDERS = Path("competition-real")
FOLDER = FOLDERS / "Incheon2026"
OTHER_FOLDER = FOLDERS / "PortugalOpen2026"
ROOMS = {"laundry table": "laundry", "bed": "bedroom", "sofa": "living room", "sink": "kitchen"}
COMMANDS = 1_200
# A whole world is imported, sampled and frozen by one worker.
JOB_SECONDS = 240


def files_of(folder: Path) -> list[Path]:
    """Return the files of a competition's folder; skip the test where it is not there."""
    files = [each for each in folder.rglob("*") if each.is_file()]
    if not files:
        pytest.skip(f"needs {folder.name} in GPSR_SHARED_DATA")
    return files


@pytest.fixture
def folder(shared_data) -> bytes:
    """The folder of the world cup in 2026, as a zip archive."""
    packed = BytesIO()
    with ZipFile(packed, "w") as archive:
        for each in files_of(shared_data / FOLDER):
            archive.write(each, each.relative_to(shared_data / FOLDERS))
    return packed.getvalue()


@pytest.fixture
def worker(transactional_db, tmp_path) -> Iterator[RunningWorker]:
    started = RunningWorker(tmp_path / "worker.log")
    yield started
    started.remove()
    print(started.log.read_text(encoding="utf-8"))


class Evening:
    """One page of a browser; each step leaves pictures in ``folder``, and its faults in ``reports``."""

    def __init__(self, page: Page, url: str, folder: Path) -> None:
        self.page = page
        self.url = url
        self.folder = folder
        self.reports: dict[str, Any] = {}

    def go(self, path: str, title: str) -> None:
        self.page.goto(f"{self.url}{path}")
        arrive(self.page, title)

    def look(self, name: str) -> None:
        """Take a picture, wide and light and then narrow and dark, and look for faults in both."""
        for variant in (NARROW_DARK, WIDE_LIGHT):
            self.page.set_viewport_size(variant.size)
            self.page.emulate_media(color_scheme=variant.theme, reduced_motion="reduce")
            self.page.evaluate(SETTLED)
            self.page.screenshot(path=self.folder / f"{name}-{variant}.png", full_page=True)
            self.reports[f"{name}-{variant}"] = look_for(self.page, OF_STRUCTURE)

    def wait_for_job(self) -> Locator:
        """Wait for the job of this page; return its report."""
        state = self.page.locator("#job-state .status")
        expect(state).to_have_text(re.compile("succeeded|failed"), timeout=1000 * JOB_SECONDS)
        expect(state).to_have_text("succeeded")
        return self.page.locator("#job-state")


def load_world(evening: Evening) -> None:
    page = evening.page
    evening.go("/", "Worlds")
    evening.look("01-worlds")
    page.click("main >> text=New world")
    arrive(page, "New world")
    page.fill("#id_name", "robocup")
    page.check("text=competition")
    evening.look("02-new-world")
    page.click("button:has-text('Create world')")
    arrive_at(page, page.locator("#job-state"))
    progress = page.locator("#job-state progress")
    expect(progress).not_to_have_attribute("value", "0", timeout=1000 * JOB_SECONDS)
    evening.look("03-loading")
    expect(evening.wait_for_job()).to_contain_text("3,000")
    evening.look("04-loaded")
    # The rail counts what has come.
    expect(page.locator("#rail a", has_text="Commands")).to_contain_text("3,000")


def import_folder(evening: Evening, folder: bytes) -> None:
    page = evening.page
    evening.go("/w/robocup/import/competition/", "Import a competition folder")
    upload = {"name": "Incheon2026.zip", "mimeType": "application/zip", "buffer": folder}
    page.set_input_files("#id_files", upload)
    evening.look("05-import")
    page.click("main button:has-text('Import') >> nth=-1")
    arrive_at(page, page.locator("#job-state"))
    evening.wait_for_job()
    warnings = page.locator(".problem--warning")
    expect(warnings).not_to_have_count(0)
    expect(page.locator(".problem--error")).to_have_count(0)
    evening.look("06-warnings")
    page.click("text=Choose rooms")
    arrive(page, "Rooms of locations")


def choose_rooms(evening: Evening) -> None:
    page = evening.page
    for location, room in ROOMS.items():
        page.get_by_label(location, exact=True).select_option(room)
    evening.look("07-rooms")
    page.click("button:has-text('Save')")
    arrive(page, "Ontology")
    evening.look("08-ontology")
    stored = Entity.objects.filter(ontology__world__name="robocup", text__in=ROOMS)
    rooms = {row.text: row.attributes.get("room") for row in stored.filter(entity_class="location")}
    assert rooms == ROOMS


def look_around(evening: Evening) -> None:
    """Through the pages on which the world is described."""
    page = evening.page
    for path, title, name in (
        ("ontology/classes/", "Classes", "09-classes"),
        ("templates/", "Templates", "10-templates"),
        ("templates/?nonterminal=person", "Templates", "11-lines"),
        ("grammar/?nonterminal=person", "Grammar", "12-grammar"),
    ):
        evening.go(f"/w/robocup/{path}", title)
        evening.look(name)
    page.locator("#list a.row-link").last.click()
    arrive(page, "Production")
    evening.look("13-production")
    expect(page.locator("main")).to_contain_text("$person -> ")


def sample(evening: Evening) -> None:
    page = evening.page
    evening.go("/w/robocup/generation/", "Generate commands")
    page.fill("#id_sample", str(COMMANDS))
    page.fill("#id_seed", "7")
    evening.look("14-generation")
    page.click("button:has-text('Generate commands')")
    arrive_at(page, page.locator("#job-state"))
    expect(evening.wait_for_job()).to_contain_text(f"{COMMANDS:,}")
    evening.look("15-generated")
    assert World.objects.get(name="robocup").commands.count() == COMMANDS
    page.goto(f"{evening.url}/w/robocup/templates/?problems=yes")
    expect(page.locator(".remark")).to_have_count(0)


def freeze(evening: Evening) -> None:
    page = evening.page
    evening.go("/w/robocup/splits/new/", "Freeze a split")
    page.fill("#id_name", "evening")
    evening.look("16-split-new")
    page.click("button:has-text('Freeze')")
    arrive(page, "evening")
    evening.look("17-split")


def train(evening: Evening, parser: str) -> None:
    """Start a run and wait for its figures."""
    page = evening.page
    evening.go(f"/w/robocup/runs/new/?parser={parser}", "Start a run")
    wait_for_swap(page)
    page.select_option("#id_split", label="evening")
    evening.look(f"18-run-new-{parser}")
    page.click("button:has-text('Start the run')")
    status = page.locator("#run-state .status").first
    expect(status).to_have_text(re.compile("succeeded|failed"), timeout=1000 * JOB_SECONDS)
    expect(status).to_have_text("succeeded")
    evening.look(f"19-run-{parser}")


def promote(evening: Evening, parser: str) -> None:
    page, run = evening.page, TrainingRun.objects.get(parser=parser)
    evening.go(f"/w/robocup/promotion/?run={run.pk}", "Promotion")
    page.click(f"button:has-text('Promote run {run.pk}')")
    expect(page.locator("#present-title")).to_contain_text(title_of(parser))
    evening.look("20-promoted")


def parse(evening: Evening, name: str, text: str) -> Locator:
    """Ask for ``text`` on the page Parse; return the answer."""
    page = evening.page
    evening.go("/w/robocup/parse/", "Parse")
    page.fill("#playground-text", text)
    answer = page.locator("#playground-answer")
    expect(answer.locator(".playground-heard")).to_be_visible()
    wait_for_swap(page)
    evening.look(name)
    return answer


def steps_of(answer: Locator) -> list[str]:
    said = answer.locator(".plan-steps code").all_inner_texts()
    return [each for each in said if "(" not in each]  # not those of the plan in primitives


def test_an_evening_of_a_team(
    page: Page,
    live_server,
    superuser,
    worker,
    parse_server,  # noqa: F811
    folder,
    tmp_path,
):
    page.set_default_timeout(1000 * PATIENCE_SECONDS)
    log_in(page, live_server.url, superuser.username, "correct horse")
    evening = Evening(page, live_server.url, tmp_path)
    load_world(evening)
    import_folder(evening, folder)
    choose_rooms(evening)
    look_around(evening)
    sample(evening)
    freeze(evening)

    parse_server.update()
    answer = parse(evening, "18-parse-at-once", "please go to the sofa")
    assert steps_of(answer) == ["go"]
    expect(answer.locator(".playground-heard .value")).to_have_text("sofa")

    train(evening, "knn")
    promote(evening, "knn")
    parse_server.update()
    answer = parse(evening, "22-parse-capital", "Bring me the hand towel from the laundry table.")
    assert steps_of(answer) == ["bring"]
    text = "please find Jane at the sofa and follow them to the kitchen"
    answer = parse(evening, "23-parse-them", text)
    assert steps_of(answer) == ["find", "follow"]
    expect(answer.locator(".plan-referent")).to_contain_text(re.compile("them.*Jane"))

    assert only_faults(evening.reports) == {}


OTHER_ROOMS = {"fridge": "kitchen", "desk": "living room"}
MOST_CLICKS = 20


def test_the_first_steps_lead_through_an_evening(
    logged_in,
    live_server,
    superuser,
    worker,
    parse_server,  # noqa: F811
    shared_data,
):
    files_of(shared_data / OTHER_FOLDER)
    page = logged_in(superuser).new_page()
    clicks = []

    def click(target: Locator, title: str = "") -> None:
        target.click()
        clicks.append(title)
        if title:
            arrive(page, title)

    def wait_for_job() -> None:
        state = page.locator("#job-state .status")
        expect(state).to_have_text("succeeded", timeout=1000 * JOB_SECONDS)

    begun = monotonic()
    page.goto(live_server.url)
    click(page.get_by_role("button", name="New world"), "New world")
    page.fill("#id_name", "open")
    click(page.get_by_text("competition", exact=True))
    click(page.get_by_role("button", name="Create world"))
    wait_for_job()
    click(page.get_by_role("button", name="Open open"), "Overview")
    click(page.get_by_role("button", name="Import the folder"), "Import a competition folder")
    page.locator("input[webkitdirectory]").set_input_files(shared_data / OTHER_FOLDER)
    clicks.append("the dialog")
    click(page.get_by_role("button", name="Import", exact=True))
    wait_for_job()
    expect(page.locator(".problem--warning").first).to_be_hidden()  # below one line
    click(page.get_by_role("button", name="Choose rooms"), "Rooms of locations")
    guessed = page.locator("main select").evaluate_all(
        "all => all.filter((each) => each.value).length"
    )
    for location, room in OTHER_ROOMS.items():
        page.get_by_label(location, exact=True).select_option(room)
        clicks.append(location)
    click(page.get_by_role("button", name="Save"), "Ontology")
    assert guessed == 6
    click(page.locator("#rail a", has_text="Overview"), "Overview")
    steps = page.locator(".first-steps")
    expect(steps.get_by_role("button", name=re.compile("^Train"))).to_be_visible()  # rooms are open
    parse_server.update()
    click(steps.get_by_role("button", name="Try a command"), "Parse")
    page.locator("#playground-text").press_sequentially("Could you get me the milk from the fridge")
    answer = page.locator("#playground-answer")
    expect(answer.locator(".plan-steps code").first).to_have_text("go_to(fridge)")
    assert steps_of(answer) == ["bring"]
    page.fill(
        "#playground-text",
        "Head to the kitchen, look for whoever's waving, and tag along with them",
    )
    expect(answer.locator(".plan-steps code").first).to_have_text("go_to(kitchen)")
    wait_for_swap(page)
    assert steps_of(answer) == ["go", "find", "follow"]
    print(f"{len(clicks)} clicks, {monotonic() - begun:.0f} seconds")
    assert len(clicks) <= MOST_CLICKS
