"""Writing a template in a browser: the checking editor, and drafts that outlive a reload."""

from __future__ import annotations

import pytest
from playwright.sync_api import expect

from annotations.models import Draft, SemanticTemplate, TaskCategory
from tests.browser.arriving import wait_for_swap
from tests.browser.conftest import give_window
from tests.browser.writing import open_editor, save_button, write

pytestmark = [pytest.mark.browser, pytest.mark.django_db(transaction=True)]

RESTORED = "Your draft of "


@pytest.fixture
def other_category(sample) -> TaskCategory:
    """A task category whose grammar knows none of the usual words."""
    return TaskCategory.objects.create(
        grammar=sample.world.grammar,
        name="empty",
        position=9,
        rule_sources=["nothing_grammar.txt"],
        template_sources=["nothing_semantics.txt"],
    )


def test_another_task_category_is_checked_anew(page_of, live_server, annotator, other_category):
    page = page_of(annotator)
    open_editor(page, live_server.url)
    report = page.locator(".editor-report").first
    page.get_by_label("Task category").select_option("empty")
    write(page, "go to the {room}", "(go {room})")
    expect(report).to_contain_text("matches nothing in the grammar")
    productions = report.get_by_role("link", name="see the productions of task category empty")
    expect(productions).to_have_attribute("href", "/w/home/grammar/?task_category=empty")
    page.get_by_label("Task category").select_option(label="1")
    expect(report).not_to_contain_text("matches nothing")
    page.get_by_label("Task category").select_option("empty")
    expect(report).to_contain_text("matches nothing in the grammar")


def test_enter_in_the_pattern_sends_nothing(page_of, live_server, annotator):
    page = page_of(annotator)
    open_editor(page, live_server.url)
    page.get_by_role("textbox", name="Pattern").fill("go")
    page.get_by_role("textbox", name="Pattern").press("Enter")
    expect(page.locator(".errorlist")).to_have_count(0)
    assert page.url.endswith("/templates/new/")


def test_a_draft_comes_back_whole_and_can_be_discarded(
    page_of, live_server, annotator, other_category
):
    page = page_of(annotator)
    open_editor(page, live_server.url)
    write(page, "go home", "(go {room}")
    page.get_by_label("Task category").select_option("empty")
    page.get_by_label("Status").select_option("draft")
    page.reload()
    expect(page.get_by_text(RESTORED)).to_be_visible()
    expect(page.locator(".cm-content").first).to_have_text("go home")
    expect(page.get_by_label("Task category")).to_have_value(str(other_category.pk))
    expect(page.get_by_label("Status")).to_have_value("draft")
    expect(page.locator(".editor-report").nth(1)).to_contain_text("ends too early")
    page.get_by_role("button", name="Discard").click()
    expect(page.get_by_label("Status")).to_have_value("ready")
    page.reload()
    expect(page.locator(".cm-editor")).to_have_count(2)
    expect(page.get_by_text(RESTORED)).to_have_count(0)


def test_a_draft_is_shown_to_its_author_alone(page_of, live_server, annotator, admin):
    page = page_of(annotator)
    open_editor(page, live_server.url)
    write(page, "go home", "(go {room})")
    give_window(page.context, admin, live_server.url)
    open_editor(page, live_server.url)
    expect(page.get_by_text(RESTORED)).to_have_count(0)
    expect(page.locator(".cm-content").first).not_to_contain_text("go home")
    give_window(page.context, annotator, live_server.url)
    open_editor(page, live_server.url)
    expect(page.get_by_text(RESTORED)).to_be_visible()


def test_logging_out_removes_the_drafts(page_of, live_server, annotator):
    page = page_of(annotator)
    open_editor(page, live_server.url)
    write(page, "go home", "(go {room})")
    page.locator(".menu summary").last.click()
    page.get_by_role("button", name="Log out").click()
    page.wait_for_url("**/login/**")
    assert (
        page.evaluate("Object.keys(localStorage).filter(name => name.startsWith('draft:'))") == []
    )


def test_a_draft_of_an_old_version_overwrites_nobody(page_of, live_server, annotator, sample):
    page = page_of(annotator)
    open_editor(page, live_server.url, str(sample.template.pk))
    page.get_by_role("textbox", name="Pattern").fill("find my $object")
    SemanticTemplate.objects.filter(pk=sample.template.pk).update(
        pattern="find a $object", version=2
    )
    open_editor(page, live_server.url, str(sample.template.pk))
    expect(page.get_by_text(RESTORED)).to_be_visible()
    save_button(page).click()
    expect(page.get_by_role("alert").first).to_contain_text("saved version 2 in the meantime")
    sample.template.refresh_from_db()
    assert sample.template.pattern == "find a $object"


def test_the_cursor_lights_a_slot_on_both_sides_and_the_selection_grows_by_subterm(
    page_of, live_server, annotator
):
    page = page_of(annotator)
    open_editor(page, live_server.url)
    write(page, "$vbfind   the {kobject}", "(find  (λ $1 e. (is_a $1 {kobject})))")
    form = page.get_by_role("textbox", name="Logical form")
    expect(page.locator(".editor-report").nth(1)).to_contain_text("find the object")
    form.press("Alt+Shift+F")
    expect(form).to_have_text("(find (λ$1:e (is_a $1 {kobject})))")
    expect(page.locator(".cm-content").first).to_have_text("$vbfind the {kobject}")
    page.keyboard.press("End")
    for _ in range(4):
        page.keyboard.press("ArrowLeft")
    expect(page.locator(".cm-slot-lit")).to_have_text(["{kobject}", "{kobject}"])
    selected = []
    for key in ("Alt+ArrowUp", "Control+i", "Alt+ArrowUp", "Alt+ArrowDown"):
        page.keyboard.press(key)
        selected.append(page.evaluate("getSelection().toString()"))
    assert selected == [
        "{kobject}",
        "(is_a $1 {kobject})",
        "(λ$1:e (is_a $1 {kobject}))",
        "(is_a $1 {kobject})",
    ]


def test_a_draft_is_offered_on_another_device(logged_in, sample, live_server, annotator):
    first, second = (logged_in(annotator).new_page() for _ in "ab")
    path = str(sample.template.pk)
    open_editor(first, live_server.url, path)
    first.get_by_role("textbox", name="Pattern").fill("find my $object")
    expect(first.get_by_text("Draft saved")).to_be_visible()
    open_editor(second, live_server.url, path)
    expect(second.get_by_text("from another device")).to_be_visible()
    second.get_by_role("button", name="Restore", exact=True).click()
    expect(second.locator(".cm-content").first).to_have_text("find my $object")
    expect(second.get_by_text("Draft saved")).to_be_visible()  # none is on its way any more
    save_button(second).click()
    expect(second.locator(".message")).to_contain_text("Saved as version 2")
    assert not Draft.objects.exists()


def test_a_lost_connection_loses_nothing(page_of, live_server, annotator):
    page = page_of(annotator)
    open_editor(page, live_server.url)
    page.context.set_offline(True)
    write(page, "go home", "(go {room})")
    expect(page.get_by_text("No connection. The draft is kept")).to_be_visible()
    page.context.set_offline(False)
    expect(page.get_by_text("Draft saved")).to_be_visible()
    assert Draft.objects.get().fields["pattern"] == "go home"


# Lets the answer to a draft that is sent from now on arrive only once `release` is called.
HOLD_ANSWERS = """() => {
  const released = new Promise((resolve) => { window.release = resolve; });
  const send = window.fetch;
  window.fetch = async (address, options) => {
    const answer = await send(address, options);
    if (!String(address).includes("/drafts/")) return answer;
    document.documentElement.dataset.held = "";
    await released;
    return answer;
  };
}"""


def test_an_expired_session_is_renewed_in_place(page_of, live_server, annotator):
    annotator.set_password("a long password")
    annotator.save()
    page = page_of(annotator)
    open_editor(page, live_server.url)
    page.context.clear_cookies(name="sessionid")
    write(page, "go to the {room}", "(go {room})")
    log_in_again = page.get_by_role("button", name="Log in again")
    expect(log_in_again).to_be_visible()
    page.evaluate(HOLD_ANSWERS)
    write(page, "go to the {room}", "(go {beacon})")
    page.locator("html[data-held]").wait_for()  # sent without a session, answered after the log-in
    wait_for_swap(page)
    log_in_again.click()
    password = page.get_by_label(f"Password of {annotator}")
    password.fill("wrong")
    password.press("Enter")
    expect(page.get_by_text("No account has this username")).to_be_visible()
    password.fill("a long password")
    password.press("Enter")
    expect(page.get_by_text("You are logged in again")).to_be_visible()
    page.evaluate("window.release()")
    expect(page.get_by_text("Draft saved")).to_be_visible()
    write(page, "go to the {room}", "(go {room})")
    expect(page.locator("#preview")).to_contain_text("1 command")
    save_button(page).click()
    expect(page.locator(".message")).to_contain_text("Saved")


def test_what_can_be_written_is_completed(page_of, live_server, annotator):
    page = page_of(annotator)
    open_editor(page, live_server.url)
    offers = page.locator(".cm-tooltip-autocomplete")

    def complete(typed: str, offered: str) -> None:
        page.keyboard.type(typed)
        expect(offers.locator("[aria-selected]")).to_contain_text(offered)
        # CodeMirror's list takes no key in its first 75 ms, so that nobody is surprised by it.
        page.wait_for_timeout(100)
        page.keyboard.press("Enter")
        expect(offers).to_have_count(0)

    page.get_by_role("textbox", name="Pattern").focus()
    complete("$vb", "find | locate")
    page.keyboard.type(" the ")
    complete("{kob", "one of the objects (known)")
    page.get_by_role("textbox", name="Logical form").focus()
    complete("(fi", "(lambda)")
    complete("(lam", "λ$1:e")
    complete("(is", "(variable, object)")
    complete("$", "the variable of a λ")
    page.keyboard.type(" ")
    complete("{", "{kobject}")
    expect(page.get_by_role("textbox", name="Pattern")).to_have_text("$vbfind the {kobject}")
    expect(page.get_by_role("textbox", name="Logical form")).to_have_text(
        "(find (λ$1:e (is_a $1 {kobject})))"
    )


def test_what_replaces_a_pattern_does_not_keep_the_look_of_its_first_word(
    page_of, live_server, annotator
):
    page = page_of(annotator)
    open_editor(page, live_server.url)
    pattern = page.get_by_role("textbox", name="Pattern")
    plain = pattern.evaluate("content => getComputedStyle(content).color")
    pattern.fill("go home")
    # As Chromium leaves it, now and then, where the text was there before the page was.
    pattern.locator(".cm-line").evaluate("line => { line.style.color = 'rgb(47, 91, 194)'; }")
    assert pattern.locator(".cm-line").evaluate("line => getComputedStyle(line).color") == plain


def test_a_missing_predicate_is_declared_as_the_form_uses_it(
    page_of, live_server, annotator, sample
):
    page = page_of(annotator)
    open_editor(page, live_server.url)
    write(page, "find the {kobject}", '(guide {kobject} "Sofa" (λ$1:e (is_a $1 {kobject})))')
    report = page.locator(".editor-report").nth(1)
    expect(report).to_contain_text("there is no predicate guide")
    expect(page.locator("#preview")).to_contain_text("Sofa for the object")  # nothing is dropped
    page.get_by_role("button", name="Declare action guide(object, text, lambda)").click()
    expect(page.get_by_text("Declared guide.")).to_be_visible()
    expect(report).not_to_contain_text("there is no predicate")
    row = sample.world.predicates.get(name="guide")
    assert (row.kind, row.signatures) == ("action", [["object", "text", "lambda"]])
    page.get_by_role("link", name="Change or delete guide").click()
    expect(page.locator("h1")).to_have_text("guide")


@pytest.mark.parametrize(
    "typed, repaired",
    [
        ("(say “hello there”)", '(say "hello there")'),
        ("(say «hello there»)", '(say "hello there")'),
        ("(say\u00a0“hello\u2009there\u200b”)", '(say "hello there")'),
    ],
)
def test_curly_quotes_and_odd_blanks_are_read_as_plain_ones(
    typed, repaired, page_of, live_server, annotator
):
    page = page_of(annotator)
    open_editor(page, live_server.url)
    write(page, "go to the\u00a0{room}", typed)
    report = page.locator(".editor-report").nth(1)
    expect(report.get_by_text("not allowed")).to_have_count(0)
    page.get_by_role("button", name="Save", exact=True).click()
    page.wait_for_url(lambda url: "new" not in url)
    saved = SemanticTemplate.objects.latest("pk")
    assert (saved.pattern, saved.form) == ("go to the {room}", repaired)


def test_the_help_stays_closed_once_it_is_closed(page_of, live_server, annotator):
    page = page_of(annotator)
    open_editor(page, live_server.url)
    help_text = page.get_by_text("a sentence that people say to the robot")
    expect(help_text).to_be_visible()  # she has written no template yet
    page.get_by_text("How to write a template").click()
    expect(help_text).to_be_hidden()
    page.reload()
    expect(page.locator(".cm-editor")).to_have_count(2)
    expect(help_text).to_be_hidden()
    page.get_by_text("How to write a template").click()
    page.reload()
    expect(help_text).to_be_visible()


def test_meaning_and_consequences_stay_in_view_beside_the_fields(
    page_of, live_server, annotator, sample
):
    page = page_of(annotator)
    page.set_viewport_size({"width": 1280, "height": 800})
    open_editor(page, live_server.url, str(sample.template.pk))
    for heading in ("Meaning", "As people say it", "When you save"):
        expect(page.get_by_role("heading", name=heading)).to_be_in_viewport()
    page.locator("#template-form").evaluate("form => { form.style.minHeight = '3000px'; }")
    page.evaluate("scrollTo(0, 1500)")
    expect(page.get_by_role("heading", name="Meaning")).to_be_in_viewport()
    page.set_viewport_size({"width": 320, "height": 640})
    assert page.evaluate("document.documentElement.scrollWidth") <= 320


def test_escape_and_the_keys_of_an_input_method_lose_nothing(page_of, live_server, annotator):
    page = page_of(annotator)
    open_editor(page, live_server.url)
    write(page, "go to the {room}", "(go {room})")
    form = page.get_by_role("textbox", name="Logical form")
    client = page.context.new_cdp_session(page)
    client.send("Input.imeSetComposition", {"text": "す", "selectionStart": 1, "selectionEnd": 1})
    for key in ("Enter", "Escape"):
        form.evaluate(
            "(field, key) => field.dispatchEvent(new KeyboardEvent('keydown', "
            "{ key, ctrlKey: key === 'Enter', isComposing: true, keyCode: 229, bubbles: true }))",
            key,
        )
    client.send("Input.insertText", {"text": "す"})
    expect(form).to_contain_text("す")
    form.press("Escape")
    assert page.url.endswith("/templates/new/")
    expect(form).to_contain_text("す")
    page.reload()
    expect(form).to_contain_text("す")  # the draft has it
