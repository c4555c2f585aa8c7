"""A whole folder is chosen in one dialog, with the paths of its files."""

from __future__ import annotations

from playwright.sync_api import expect

from annotations.models import Job
from tests.annotations.language.world.test_competition_folder import FOLDER


def test_a_folder_is_chosen_in_one_dialog(page_of, live_server, admin, tmp_path):
    files = {**FOLDER, "objects/cup.png": "\x89PNG", ".git/config": "x"}
    for path, text in files.items():
        (tmp_path / "event" / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "event" / path).write_text(text)
    page = page_of(admin)
    page.goto(f"{live_server.url}/w/home/import/competition/")
    page.locator("input[webkitdirectory]").set_input_files(tmp_path / "event")
    expect(page.get_by_text("4 files chosen")).to_be_visible()
    assert page.locator("[name=paths]").first.input_value().startswith("event/")
    page.get_by_role("button", name="Import", exact=True).click()
    expect(page.get_by_role("heading", name="Imported")).to_be_visible()
    assert Job.objects.latest("pk").report["entities"]["room"] == 2
