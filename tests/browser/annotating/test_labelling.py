"""Labelling when others are faster, the session ends or the connection is lost."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import pytest
from playwright.sync_api import Page, expect

from annotations.labelling.collecting import collect
from annotations.labelling.enqueuing import set_share
from annotations.labelling.label_answers import label
from annotations.models import Draft, Label, Utterance, Verdict, WorkKind
from tests.browser.conftest import give_window
from tests.waiting import wait_for

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

SAID = ["find the tea now", "find the tea please"]


@pytest.fixture
def label_page(page_of, live_server, sample, annotator) -> Page:
    collect(sample.world, SAID, by=annotator)
    page = page_of(annotator)
    with holding_two(page):
        page.goto(f"{live_server.url}/w/home/label/")
    return page


@contextmanager
def holding_two(page: Page) -> Iterator[None]:
    """After what opens the page, wait until an utterance is asked about and the next one has been fetched."""
    with page.expect_response("**/label/item/**"):
        yield
    wait_until_asked(page)


def wait_until_asked(page: Page) -> None:
    """Wait until the utterance on the page can be answered: somebody has had the time to read it."""
    expect(page.locator("[data-item][data-asks]")).to_have_count(1)


@pytest.fixture
def blind_page(sample, annotator, label_page) -> Page:
    """The page, where two people are to label each utterance."""
    Label.objects.all().delete()
    sample.world.work_items.all().delete()
    set_share(sample.world, WorkKind.UNLABELLED, 100)
    collect(sample.world, [f"find the tea {number} times" for number in range(3)], by=annotator)
    with holding_two(label_page):
        label_page.reload()
    expect(label_page.locator("[data-item]")).to_contain_text("Two people label this one")
    return label_page


def answered(page: Page) -> list[str]:
    """The utterances of all answers, once those on their way have arrived."""
    kept = "Object.keys(localStorage).filter((name) => name.startsWith('answers:')).map((name) => localStorage[name])"
    wait_for(lambda: set(page.evaluate(kept)) <= {"[]"}, "the answers have arrived")
    return list(Label.objects.order_by("pk").values_list("utterance__text", flat=True))


# Four presses of 1, or clicks on it, as quick as the page can be: a busy machine does not make them slow.
QUICKLY = """async (what) => {
  for (let count = 0; count < 4; count += 1) {
    if (what === "click") document.querySelector("[data-digit='1']").click();
    else document.body.dispatchEvent(new KeyboardEvent(what, { key: "1", bubbles: true }));
    await new Promise((resolve) => setTimeout(resolve, 1));
  }
}"""


def test_quick_presses_answer_one_utterance(blind_page):
    page = blind_page
    page.evaluate(QUICKLY, "keydown")
    expect_utterance(page, SAID[1])
    page.dispatch_event("[data-item]", "keydown", {"key": "1", "bubbles": True, "repeat": True})
    assert answered(page) == SAID[:1]
    page.evaluate(QUICKLY, "click")
    expect_utterance(page, "find the tea 0 times")
    assert answered(page) == SAID
    assert not Utterance.objects.filter(text__in=SAID).labelled().exists()


def test_presses_wait_for_the_next_utterance(blind_page):
    page = blind_page
    waiting = []
    page.route("**/label/item/**", lambda route: waiting.append(route))
    page.keyboard.press("1")  # the next one is there, the one after that is on its way
    expect_utterance(page, SAID[1])
    wait_until_asked(page)
    for key in "11ued":
        page.keyboard.press(key)
    expect(page.locator("[data-key-ignored]")).to_contain_text("d ")
    assert answered(page) == SAID
    assert not page.locator("[data-label-panel-place] form").count()
    waiting.pop().continue_()
    expect_utterance(page, "find the tea 0 times")


def test_two_tabs_of_one_person_are_one_party(blind_page, live_server):
    page, other = blind_page, blind_page.context.new_page()
    page.keyboard.press("e")
    expect(page.locator("[data-label-panel-place] .cm-content")).to_be_focused()
    other.goto(f"{live_server.url}/w/home/label/")
    expect_utterance(other, SAID[0])
    other.keyboard.press("u")
    expect_utterance(other, SAID[1])
    assert answered(other) == SAID[:1]
    page.bring_to_front()
    page.keyboard.press("Control+Enter")
    expect_utterance(page, SAID[1])
    valid = Label.objects.valid().filter(utterance__text=SAID[0])
    assert [each.verdict for each in valid] == [Verdict.FORM]
    assert Utterance.objects.get(text=SAID[0]).status == "unlabelled"
    page.goto(f"{live_server.url}/w/home/label/?utterance={valid.get().utterance_id}")
    expect(page.locator("[data-item]")).to_contain_text("Another answer replaces it")


def expect_utterance(page: Page, text: str) -> None:
    """Wait until an utterance is shown and takes keys."""
    key = Utterance.objects.get(text=text).pk
    expect(page.locator(f"[data-item='{key}'][data-asks]")).to_have_count(1)


def test_an_answer_to_what_somebody_else_has_answered(label_page, admin):
    page = label_page
    expect_utterance(page, SAID[0])
    label(Utterance.objects.get(text=SAID[0]), Verdict.UNKNOWN, "", admin, 1)
    page.keyboard.press("1")
    expect_utterance(page, SAID[1])
    expect(page.get_by_role("alert")).to_contain_text("adam has changed this utterance")
    page.get_by_role("button", name="Show it").click()
    expect_utterance(page, SAID[0])
    assert Utterance.objects.get(text=SAID[0]).status == "unknown"


def test_answers_outlive_the_session(label_page, live_server, annotator):
    page = label_page
    page.context.clear_cookies()
    page.keyboard.press("1")
    page.wait_for_function(f"localStorage.getItem('answers:{annotator.pk}')?.length > 2")
    give_window(page.context, annotator, live_server.url)
    page.goto(f"{live_server.url}/w/home/label/")
    expect(page.locator(".label-last")).to_contain_text(SAID[0])
    wait_for(Utterance.objects.labelled().filter(text=SAID[0]).exists, "the answer is stored")


def test_answers_without_a_connection_arrive_later(label_page, live_server):
    page = label_page
    page.context.set_offline(True)
    page.keyboard.press("1")
    expect(page.locator("#connection")).to_be_visible()
    page.context.set_offline(False)
    page.goto(f"{live_server.url}/w/home/label/")
    expect(page.locator(".label-last")).to_contain_text(SAID[0])
    wait_for(Utterance.objects.labelled().filter(text=SAID[0]).exists, "the answer is stored")


def write_form(page: Page, text: str) -> None:
    page.keyboard.press("e")
    expect(page.locator("[data-label-panel-place] .cm-content")).to_be_focused()
    page.keyboard.press("ControlOrMeta+a")
    page.keyboard.type(text)


def expect_form(page: Page, text: str) -> None:
    expect(page.locator("[data-label-panel-place] .cm-content")).to_contain_text(text)


def test_what_is_typed_outlives_escape_reload_back_and_another_device(
    label_page, live_server, annotator, page_of
):
    page = label_page
    write_form(page, "(go 17)")
    page.keyboard.press("Escape")
    page.keyboard.press("Escape")
    expect(page.locator("[data-label-panel-place] form")).to_have_count(0)
    page.keyboard.press("e")
    expect_form(page, "(go 17)")
    page.reload()
    expect_form(page, "(go 17)")
    page.goto(f"{live_server.url}/w/home/utterances/")
    page.go_back()
    expect_form(page, "(go 17)")
    wait_for(lambda: "17" in str(Draft.objects.values_list("fields")), "the draft is on the server")
    page.close()  # a page that is open keeps what it shows
    other = page_of(annotator)
    other.goto(f"{live_server.url}/w/home/label/")
    expect_utterance(other, SAID[0])
    other.keyboard.press("e")
    other.get_by_role("button", name="Restore").click()
    expect_form(other, "(go 17)")
    other.locator("[data-label-panel-place]").get_by_role("button", name="Save and go on").click()
    expect_utterance(other, SAID[1])
    assert Utterance.objects.get(text=SAID[0]).logical_form == "( go 17 )"
    wait_for(lambda: not Draft.objects.exists(), "the draft is gone")


def test_a_written_answer_that_arrives_late_leaves_what_was_taken_back_meanwhile(label_page):
    page, late = label_page, []
    page.keyboard.press("1")
    expect_utterance(page, SAID[1])
    expect(page.locator(".label-last")).to_contain_text(SAID[0])
    write_form(page, "(go 17)")
    page.route("**/answer/", lambda route: late.append(route))
    with page.expect_request("**/answer/"):
        page.keyboard.press("Control+Enter")
    page.locator("form[data-take-back] button").first.click()
    expect_utterance(page, SAID[0])
    with page.expect_response("**/answer/"):
        late.pop().continue_()
    wait_for(Utterance.objects.labelled().filter(text=SAID[1]).exists, "the answer is stored")
    expect_utterance(page, SAID[0])


@pytest.mark.parametrize(
    ("key", "field", "text"), [("d", "reason", "two robots"), ("m", "words", "tea now")]
)
def test_the_other_panels_keep_what_is_typed(label_page, key, field, text):
    page = label_page
    page.keyboard.press(key)
    page.locator(f"[data-label-panel-place] [name={field}]").fill(text)
    page.keyboard.press("Escape")
    page.keyboard.press(key)
    expect(page.locator(f"[data-label-panel-place] [name={field}]")).to_have_value(text)
    page.reload()
    expect(page.locator(f"[data-label-panel-place] [name={field}]")).to_have_value(text)


def test_keys_of_an_input_method_are_no_commands(label_page):
    page = label_page
    page.keyboard.press("d")
    reason = page.locator("[data-label-panel-place] [name=reason]")
    reason.fill("へや")
    for key in ("Escape", "Enter"):
        reason.dispatch_event("keydown", {"key": key, "isComposing": True, "bubbles": True})
    expect(reason).to_have_value("へや")
    assert not Label.objects.exists()
    page.keyboard.press("Escape")
    expect(reason).to_have_count(0)


@pytest.mark.parametrize(
    ("key", "code"),
    [("&", "Digit1"), ("U", "KeyU"), ("г", "KeyU"), ("ы", "KeyS")],
    ids=["AZERTY", "Caps Lock", "Russian u", "Russian s"],
)
def test_shortcuts_obey_on_keyboards_of_any_layout(label_page, key, code):
    page = label_page
    event = {"key": key, "code": code, "bubbles": True, "cancelable": True}
    expect_utterance(page, SAID[0])
    page.evaluate(
        "event => document.body.dispatchEvent(new KeyboardEvent('keydown', event))", event
    )
    expect_utterance(page, SAID[1])
