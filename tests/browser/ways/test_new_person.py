"""The way of a new person, without Django's admin: invited, joined, given a role, with a token, and gone."""

from __future__ import annotations

import pytest
from playwright.sync_api import Page, expect

from tests.browser.arriving import arrive

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

PASSWORD = "a battery staple"


def invite(adams: Page, url: str) -> str:
    """Let an admin make a link for one annotator, by keyboard, and return it."""
    adams.goto(f"{url}/w/home/people/")
    adams.get_by_label("For whom").focus()
    adams.keyboard.type("Nora")
    adams.keyboard.press("Tab")
    adams.keyboard.press("Space")
    adams.keyboard.press("Enter")
    link = adams.get_by_role("textbox", name="Link of the invitation")
    expect(link).to_be_focused()
    return link.input_value()


def sign_up(noras: Page, link: str) -> None:
    """Let somebody without an account follow the link and make one."""
    noras.goto(link)
    expect(noras.locator("main")).to_contain_text("adam invites you to join home as annotator.")
    noras.get_by_label("Username").fill("nora")
    noras.get_by_label("Password", exact=True).fill(PASSWORD)
    noras.get_by_label("Password again").fill(PASSWORD)
    noras.keyboard.press("Enter")
    arrive(noras, "Overview")


def make_token(noras: Page) -> str:
    """Let her make a token on the page of her account, and return it."""
    noras.locator("summary", has_text="nora").click()
    noras.get_by_role("link", name="Account and tokens").click()
    arrive(noras, "Account")
    noras.get_by_label("What it is for").fill("robot")
    noras.get_by_label("Scope").select_option("annotate")
    noras.get_by_role("button", name="Make a token").click()
    return noras.get_by_role("textbox", name="The new token").input_value()


def test_the_way_of_a_new_person(logged_in, sample, live_server, admin):
    url = live_server.url
    adams, noras = logged_in(admin).new_page(), logged_in(None).new_page()
    link = invite(adams, url)
    sign_up(noras, link)
    assert noras.goto(f"{url}/w/home/label/").status == 200
    expect(noras.get_by_role("link", name="Site administration")).to_have_count(0)

    adams.goto(f"{url}/w/home/people/")
    roles = adams.get_by_role("group", name="Roles of nora")
    expect(roles.get_by_label("Annotator")).to_be_checked()
    roles.get_by_label("Annotator").uncheck()
    roles.get_by_label("Reviewer").check()
    adams.get_by_role("button", name="Save the roles of nora").click()
    expect(adams.locator(".message")).to_contain_text("nora is now reviewer of home.")
    assert noras.goto(f"{url}/w/home/label/").status == 403

    noras.goto(f"{url}/w/home/")
    headers = {"Authorization": f"Bearer {make_token(noras)}"}
    program = logged_in(None).request
    items = f"{url}/api/v1/worlds/home/work-items/"
    assert program.get(items).status == 401
    assert program.get(items, headers=headers).status == 200
    assert program.post(f"{items}next/", headers=headers).status in (200, 204)

    adams.get_by_role("button", name="Remove nora").click()
    expect(adams.locator(".message")).to_contain_text("nora is no longer a member of home.")
    assert noras.goto(f"{url}/w/home/").status == 404
    assert program.get(items, headers=headers).status == 404
    adams.get_by_role("link", name="Audit log").click()
    arrive(adams, "Audit log")
    done = adams.locator("tbody tr td:nth-child(3)").all_inner_texts()
    assert done == ["change roles", "change roles", "join", "invite"]

    again = logged_in(None).new_page()
    assert again.goto(link).status == 404
    expect(again.locator("main")).to_contain_text("This invitation is over.")
