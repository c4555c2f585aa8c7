"""What somebody types is lost by no reload, log-in, conflict or refusal, and the list of drafts leads back to it."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest
from django.test import Client
from playwright.sync_api import Page, expect

from annotations.labelling.collecting import collect
from annotations.labelling.enqueuing import set_share
from annotations.labelling.giving import next_item
from annotations.labelling.item_answers import answer
from annotations.models import Comment, Draft, User, Verdict, WorkKind, World
from annotations.models.worlds import Role
from parser_service.models import Review
from tests.browser.arriving import arrive
from tests.browser.conftest import give_window
from tests.browser.walking import enter, tab_to
from tests.conftest import member
from tests.filled_world import leave_traces
from tests.gpsr_site.routes.addresses import address
from tests.gpsr_site.routes.listing import API_ROUTES
from tests.gpsr_site.routes.policy import POLICY, YES
from tests.sample_world import SampleWorld
from tests.waiting import wait_for

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

# Writes into the first text of each form that keeps drafts; returns what the forms are called.
TYPE_EVERYWHERE = """() => [...document.querySelectorAll("form[data-draft]")].map((form) => {
  const text = "textarea[name], input[type=text][name]";
  const field = [...form.querySelectorAll(text)].find((field) => !field.readOnly && !field.disabled);
  if (!field) return `${form.dataset.draft} has no text`;
  field.value = `kept ${field.name}`;
  field.dispatchEvent(new Event("input", { bubbles: true }));
  return form.dataset.draft;
})"""
PUT_BACK = """() => [...document.querySelectorAll("form[data-draft]:has(> .draft-note)")]
  .filter((form) => [...form.elements].some((field) => field.value === `kept ${field.name}`))
  .map((form) => form.dataset.draft)"""
LOCAL = "Object.keys(localStorage).filter((name) => name.startsWith('draft:'))"


@pytest.fixture
def filled(sample, annotator, admin) -> SampleWorld:
    leave_traces(sample.world, annotator, admin)
    User.objects.filter(pk=admin.pk).update(is_superuser=True)
    return replace(sample, form=sample.world.logical_forms.first())


def pages_with_drafts(sample: SampleWorld, client: Client) -> list[str]:
    """Every page with a form that keeps drafts."""
    names = {rule.name for rule in POLICY if (rule.method, rule.admin) == ("get", YES)}
    paths = [address(name, sample) for name in sorted(names - set(API_ROUTES))]
    pages = {path: client.get(path, follow=True) for path in paths}
    return [path for path, page in pages.items() if b"data-draft=" in b"".join(page)]


def test_every_form_that_keeps_drafts_shows_them_after_a_reload(
    filled, adam, admin, page_of, live_server
):
    page, lost = page_of(admin), {}
    paths = pages_with_drafts(filled, adam)
    assert len(paths) > 20
    for path in paths:
        page.goto(f"{live_server.url}{path}")
        page.wait_for_load_state("networkidle")
        typed = page.evaluate(TYPE_EVERYWHERE)
        page.reload()
        page.wait_for_load_state("networkidle")
        back = page.evaluate(PUT_BACK)
        if set(typed) - set(back):
            lost[path] = sorted(set(typed) - set(back))
        page.evaluate("localStorage.clear()")
        Draft.objects.all().delete()
    assert lost == {}


@pytest.fixture
def review_page(page_of, live_server, sample, reviewer) -> Page:
    page = page_of(reviewer)
    page.goto(f"{live_server.url}/w/home/review/?run={sample.run.pk}&outcome=wrong")
    expect(page.locator(f"#answer-{sample.run.pk}")).to_be_focused()
    return page


def write_note(page: Page, text: str) -> None:
    page.keyboard.press("i")
    page.keyboard.type(text)


def test_a_note_that_nobody_has_sent_is_there_after_a_closed_tab_and_another_name_of_the_world(
    review_page, sample, live_server
):
    page = review_page
    write_note(page, "Is this so?")
    address = page.url.replace("/w/home/", "/w/house/")
    World.objects.filter(pk=sample.world.pk).update(name="house")
    context = page.context
    page.close()
    page = context.new_page()
    page.goto(address)
    expect(page.locator(".draft-note")).to_contain_text("Your draft of")
    note = page.locator("[data-note]")
    expect(note).to_have_value("Is this so?")
    page.get_by_role("button", name="Discard").click()
    expect(note).to_have_value("")
    page.reload()
    expect(page.locator(".draft-note")).to_have_count(0)


def test_a_note_that_was_saved_is_no_draft(review_page, sample):
    page = review_page
    write_note(page, "Is this so?")
    page.keyboard.press("Enter")
    wait_for(Review.objects.by_people().exists, "the note is stored")
    expect(page.locator(f"#answer-{sample.run.pk}")).to_be_focused()
    wait_for(lambda: page.evaluate(LOCAL) == [], "the draft is gone")
    expect(page.locator("[data-note]")).to_have_value("Is this so?")
    expect(page.locator(".draft-note")).to_have_count(0)


def test_a_doubt_that_was_sent_is_not_put_back_into_its_empty_form(review_page, sample):
    page = review_page
    page.keyboard.press("d")
    page.keyboard.type("It says go.")
    page.keyboard.press("Enter")
    expect(page.locator("#review-said")).to_be_visible()
    assert page.evaluate(LOCAL) == []
    expect(page.locator("#review-reason")).to_have_value("")


def log_in(page: Page, user: User) -> None:
    user.set_password("a long password")
    user.save()
    page.get_by_label("Username").fill(user.username)
    page.get_by_label("Password").fill("a long password")
    page.get_by_role("button", name="Log in").click()


def test_a_note_outlives_the_session_in_which_it_was_sent(review_page, reviewer):
    page = review_page
    page.context.clear_cookies(name="sessionid")
    write_note(page, "Is this so?")
    page.keyboard.press("Enter")
    page.wait_for_url("**/login/**")
    log_in(page, reviewer)
    page.wait_for_url("**/review/**")
    expect(page.locator("[data-note]")).to_have_value("Is this so?")
    assert not Review.objects.by_people().exists()


def comments_of(page: Page, url: str, sample: SampleWorld) -> str:
    page.goto(f"{url}/w/home/templates/{sample.template.pk}/")
    page.locator("#comments textarea").wait_for()
    return page.url


def test_a_comment_outlives_the_session_in_which_it_was_sent(
    page_of, live_server, sample, annotator
):
    page = page_of(annotator)
    address = comments_of(page, live_server.url, sample)
    page.context.clear_cookies(name="sessionid")
    page.locator("#comments textarea").fill("Who says this?")
    page.get_by_role("button", name="Comment", exact=True).click()
    page.wait_for_url("**/login/**")
    log_in(page, annotator)
    page.goto(f"{live_server.url}/w/home/")  # wherever one goes first
    page.goto(address)
    expect(page.locator("#comments textarea")).to_have_value("Who says this?")
    page.get_by_role("button", name="Comment", exact=True).click()
    wait_for(Comment.objects.exists, "the comment is stored")
    expect(page.locator("#comments textarea")).to_have_value("")
    assert page.evaluate(LOCAL) == []


@pytest.mark.parametrize("status", [403, 404, 500])
def test_a_page_that_says_no_keeps_what_was_sent(
    status, page_of, live_server, sample, annotator, settings
):
    page = page_of(annotator)
    address = comments_of(page, live_server.url, sample)
    page.locator("#comments textarea").fill("Who says this?")
    page.route(
        "**/comments/**",
        lambda route: route.fulfill(
            status=status, body="<title>No</title>", content_type="text/html"
        ),
    )
    page.get_by_role("button", name="Comment", exact=True).click()
    expect(page).to_have_title("No")
    page.goto(f"{live_server.url}/w/home/")
    page.goto(address)
    expect(page.locator("#comments textarea")).to_have_value("Who says this?")


def test_a_comment_that_was_changed_meanwhile_stays_a_draft(
    page_of, live_server, sample, annotator
):
    texts = {"about": str(sample.template), "text": "one", "author": annotator}
    comment = Comment.objects.create(
        world=sample.world, kind="template", subject=sample.template.pk, **texts
    )
    page = page_of(annotator)
    page.goto(f"{live_server.url}/w/home/comments/{comment.pk}/")
    Comment.objects.update(text="two", version=2)
    page.locator("main textarea").fill("three")
    page.get_by_role("button", name="Save", exact=True).click()
    expect(page.locator(".errorlist")).to_be_visible()
    assert "three" in json.dumps(page.evaluate("localStorage"))
    page.goto(page.url)
    expect(page.locator("main textarea")).to_have_value("three")


@pytest.fixture
def compared(sample, annotator, admin) -> str:
    """The address of an item in which somebody compares the labels of two people."""
    world, other = sample.world, member(sample.world, "berta", Role.ANNOTATOR)
    set_share(world, WorkKind.UNLABELLED, 100)
    collect(world, ["find the tea now"], by=annotator)
    for person, form in ((annotator, "( go 1 )"), (other, "( go 2 )")):
        part = next_item(person, world)
        answer(part.item.utterance, Verdict.FORM, form, person, part.item.utterance.version)
    return f"/w/home/queue/{part.item.followed_by.pk}/"


def test_what_is_written_in_an_adjudication_is_kept_with_its_choice(
    compared, page_of, live_server, admin
):
    page = page_of(admin)
    page.goto(f"{live_server.url}{compared}")
    page.get_by_role("button", name="Take this item").click()
    other = page.locator("[name=choice]").last
    other.check()
    page.locator("main form [name=form]").fill("(go 17)")
    page.reload()
    expect(page.locator("[name=choice]").last).to_be_checked()
    expect(page.locator("main form [name=form]")).to_have_value("(go 17)")
    page.get_by_role("button", name="Settle it").click()
    page.wait_for_url("**/queue/")
    assert page.evaluate(LOCAL) == []


def test_another_person_in_the_same_browser_sees_none(
    page_of, live_server, sample, annotator, admin
):
    page = page_of(annotator)
    address = comments_of(page, live_server.url, sample)
    page.locator("#comments textarea").fill("Who says this?")
    give_window(page.context, admin, live_server.url)
    page.goto(address)
    expect(page.locator("#comments textarea")).to_have_value("")
    page.goto(f"{live_server.url}/drafts/")
    expect(page.get_by_text("No drafts.")).to_be_visible()


def test_my_drafts_lists_both_kinds_by_keyboard_and_forgets_on_request(
    page_of, live_server, sample, annotator
):
    collect(sample.world, ["find the tea now"], by=annotator)
    page = page_of(annotator)
    address = comments_of(page, live_server.url, sample)
    page.locator("#comments textarea").fill("Who says this?")
    page.goto(f"{live_server.url}/w/home/label/")
    expect(page.locator("[data-label-page][data-ready]")).to_have_count(1)
    page.keyboard.press("d")
    page.locator("[data-label-panel-place] [name=reason]").fill("two robots")
    wait_for(Draft.objects.exists, "the draft is on the server")
    tab_to(page, page.locator(".topbar .menu summary").last, key="Shift+Tab")
    page.keyboard.press("Enter")
    tab_to(page, page.get_by_role("link", name="My drafts"))
    enter(page, "My drafts")
    server = page.get_by_role("region", name="On the server")
    expect(server.get_by_role("link")).to_have_text("Dispute: find the tea now")
    browser = page.get_by_role("region", name="In this browser")
    expect(browser).to_contain_text("These lie in this browser alone")
    expect(browser.get_by_role("link")).to_have_text(f"Comment: {sample.template}")
    expect(browser).to_contain_text("Who says this?")
    page.keyboard.press("j")  # rows, as in every list
    page.keyboard.press("Enter")
    arrive(page, "Label")
    expect(page.locator("[data-label-panel-place] [name=reason]")).to_have_value("two robots")
    page.goto(f"{live_server.url}/drafts/")
    arrive(page, "My drafts")
    for region in (server, browser):
        discard, undo = (region.get_by_role("button", name=name) for name in ("Discard", "Undo"))
        for _ in range(2):
            discard.press("Enter")
            expect(undo).to_be_focused()
            kept = " ".join(page.evaluate(LOCAL))
            assert not Draft.objects.exists() if region is server else "comment" not in kept
            undo.press("Enter")
            expect(discard).to_be_focused()
        assert Draft.objects.get().fields["reason"] == "two robots"
    discard.press("Enter")
    expect(undo).to_be_focused()
    page.goto(address)
    expect(page.locator("#comments textarea")).to_have_value("")


def test_there_are_few_and_none_stays_for_ever(page_of, live_server, sample, annotator):
    page = page_of(annotator)
    comments_of(page, live_server.url, sample)
    page.evaluate(
        """of => {
      const put = (name, savedAt) => localStorage.setItem(`draft:${of}:${name}`, JSON.stringify({fields: {}, savedAt}));
      for (let day = 0; day < 250; day += 1) put(`1-day-${day}`, Date.now() - day * 86400000);
      localStorage.setItem(`draft:${of}:home-note-1`, JSON.stringify({fields: {}})); // of an earlier version
    }""",
        annotator.pk,
    )
    page.reload()
    page.locator("#comments textarea").wait_for()
    assert len(page.evaluate(LOCAL)) == 183
