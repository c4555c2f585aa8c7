"""How many clicks an admin needs, from Overview on, for what stands in Settings. Typing into fields is no click."""

from __future__ import annotations

import pytest
from playwright.sync_api import Locator, Page, expect

from annotations.models import Entity, Invitation, World
from tests.annotations.conftest import TINY
from tests.browser.arriving import arrive

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]


class Clicks:
    """Clicks on things, and counts how often."""

    def __init__(self) -> None:
        self.count = 0

    def on(self, target: Locator) -> None:
        target.click()
        self.count += 1


@pytest.fixture
def clicks() -> Clicks:
    return Clicks()


def open_overview(page: Page, url: str) -> Page:
    page.goto(f"{url}/w/home/")
    arrive(page, "Overview")
    return page


def test_an_invitation_takes_three_clicks(page_of, live_server, admin, clicks):
    page = open_overview(page_of(admin), live_server.url)
    clicks.on(page.get_by_role("link", name="Settings", exact=True))
    arrive(page, "People")
    page.get_by_label("For whom").fill("Nora")
    clicks.on(page.locator("#invite").get_by_label("Annotator"))
    clicks.on(page.get_by_role("button", name="Make a link"))
    link = page.get_by_role("textbox", name="Link of the invitation")
    expect(link).to_be_focused()
    assert "/join/" in link.input_value()
    assert Invitation.objects.open().count() == 1
    assert clicks.count == 3


def test_one_s_own_password_takes_three_clicks(page_of, live_server, admin, clicks):
    page = open_overview(page_of(admin), live_server.url)
    clicks.on(page.locator("summary", has_text=admin.username))
    clicks.on(page.get_by_role("link", name="Change password"))
    arrive(page, "Change password")
    old, *new = page.locator("main input[type=password]").all()
    old.fill("correct horse")
    for field in new:
        field.fill("a battery staple")
    clicks.on(page.get_by_role("main").get_by_role("button", name="Change password"))
    expect(page.locator(".message")).to_be_visible()
    admin.refresh_from_db()
    assert admin.check_password("a battery staple")
    assert clicks.count == 3


def test_a_new_world_is_imported_and_generated_in_six_clicks(
    page_of, live_server, superuser, clicks, tmp_path
):
    for name, text in TINY.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    page = open_overview(page_of(superuser), live_server.url)
    clicks.on(page.locator(".world-switch summary"))
    clicks.on(page.get_by_role("link", name="New world"))
    arrive(page, "New world")
    page.get_by_label("Name").fill("laboratory")
    clicks.on(page.get_by_role("button", name="Create world"))
    arrive(page, "Overview")
    clicks.on(page.get_by_role("button", name="Import files"))
    arrive(page, "Import and export")
    page.get_by_label("Files", exact=True).set_input_files(sorted(tmp_path.iterdir()))
    clicks.on(page.get_by_role("button", name="Import", exact=True))
    expect(page.locator("main")).to_contain_text("3 commands wait to be generated.")
    (button,) = page.locator("main .primary").all()
    expect(button).to_have_text("Generate commands")
    clicks.on(button)
    arrive(page, "Commands")
    assert World.objects.get(name="laboratory").commands.count() == 3
    assert clicks.count == 6


def test_an_object_takes_two_clicks_and_its_name_is_typed_at_once(
    page_of, live_server, admin, clicks
):
    page = open_overview(page_of(admin), live_server.url)
    clicks.on(page.locator("#rail a", has_text="Ontology"))
    arrive(page, "Ontology")
    clicks.on(page.get_by_role("button", name="New entity"))
    arrive(page, "New entity")
    expect(page.get_by_label("Name", exact=True)).to_be_focused()
    page.keyboard.type("kettle")
    page.keyboard.press("Enter")
    arrive(page, "kettle")
    assert Entity.objects.get(text="kettle").entity_class == "object"
    assert clicks.count == 2


def test_undo_brings_back_who_was_removed(page_of, live_server, admin, annotator):
    page = page_of(admin)
    page.goto(f"{live_server.url}/w/home/people/")
    page.get_by_role("button", name=f"Remove {annotator}").click()
    message = page.locator(".message")
    expect(message).to_contain_text(f"{annotator} is no longer a member of home.")
    message.get_by_role("button", name="Undo").click()
    expect(page.locator(".message")).to_contain_text(f"{annotator} is annotator of home again.")
    expect(
        page.get_by_role("group", name=f"Roles of {annotator}").get_by_label("Annotator")
    ).to_be_checked()
