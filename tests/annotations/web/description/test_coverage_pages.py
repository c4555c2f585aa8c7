"""Commands without a form, and how a template begins from one of them."""

from __future__ import annotations

from urllib.parse import parse_qs, quote, urlsplit

import pytest

from annotations.editing.edits import add, delete
from annotations.models import SemanticTemplate, World

PAGE = "/w/home/coverage/"
NEW = "/w/home/templates/new/"


@pytest.fixture
def without_go(sample, annotator) -> World:
    """The sample world without the template that says where to go."""
    row = SemanticTemplate.objects.get(grammar__world=sample.world, pattern__startswith="go")
    delete(row, annotator, row.version)
    return sample.world


def commands_on(client, query: str = "") -> list[str]:
    return [row.text for row in client.get(PAGE + query).context["listing"].rows]


def test_a_covered_grammar_has_nothing_to_list(sample, anna):
    page = anna.get(PAGE)
    assert page.context["listing"].total == 0
    assert '<div class="empty">' in page.content.decode()


def test_a_command_without_a_form_leads_to_a_new_template(without_go, anna):
    page = anna.get(PAGE)
    assert commands_on(anna) == ["go to the <room>"]
    address = f"{NEW}?task_category=1&amp;command={quote('go to the <room>')}"
    assert f'href="{address}"' in page.content.decode()


def test_reviewers_see_the_list_and_no_link(without_go, rene):
    page = rene.get(PAGE)
    assert page.context["listing"].total == 1 and NEW not in page.content.decode()


def test_bars_lead_to_the_commands_of_a_nonterminal(sample, anna, annotator):
    row = SemanticTemplate.objects.get(grammar__world=sample.world, pattern__startswith="$vbfind")
    delete(row, annotator, row.version)
    context = anna.get(PAGE).context
    bars = {share.nonterminal: (share.uncovered, url) for share, url in context["bars"]}
    assert bars == {"object": (2, "?nonterminal=object"), "vbfind": (2, "?nonterminal=vbfind")}
    assert commands_on(anna, "?nonterminal=vbfind") == ["find the <object>", "locate the <object>"]


def test_the_list_is_searched_and_filtered_by_the_address(sample, anna, annotator):
    for row in SemanticTemplate.objects.filter(grammar__world=sample.world):
        delete(row, annotator, row.version)
    assert len(commands_on(anna)) == 3
    assert commands_on(anna, "?q=LOCATE the") == ["locate the <object>"]
    assert len(commands_on(anna, "?task_category=1")) == 3
    unknown = anna.get(PAGE + "?task_category=nowhere")
    assert unknown.context["listing"].has_unknown_filters


def test_pages_have_numbers(sample, anna, annotator, monkeypatch):
    for row in SemanticTemplate.objects.filter(grammar__world=sample.world):
        delete(row, annotator, row.version)
    listing = anna.get(PAGE + "?page=999").context["listing"]
    assert (listing.summary, listing.next_url, listing.previous_url) == ("1–3 of 3", "", "")


@pytest.mark.parametrize(
    "pattern, begun", [("go at once to the {room}", "(go {room})"), ("walk to the {room}", "")]
)
def test_a_new_template_begins_with_a_pattern_and_a_form_that_is_no_guess(
    pattern, begun, without_go, anna, annotator
):
    category = without_go.grammar.task_categories.get()
    made = SemanticTemplate.for_category(
        category, pattern=pattern, form="(go {room})", status="ready"
    )
    add(made, annotator)
    page = anna.get(NEW, {"task_category": "1", "command": "go to the <room>"})
    form = page.context["form"]
    assert (form["pattern"].value(), form["form"].value()) == ("go to the {room}", begun)
    assert [each.text for each in page.context["suggestions"]][:1] == ["(go {room})"]
    assert page.context["suggestions"][0].gloss == page.context["example"] != ""
    assert 'type="radio"' in page.content.decode()


def test_the_suggested_template_covers_the_command(without_go, anna, annotator):
    page = anna.get(NEW, {"command": "go to the <room>"})
    values = {
        "pattern": page.context["form"]["pattern"].value(),
        "form": "(go {room})",
        "status": "ready",
        "task_category": page.context["form"]["task_category"].value(),
    }
    anna.post(f"{NEW}?command={quote('go to the <room>')}", values)
    assert commands_on(anna) == []


def test_an_empty_world_suggests_a_pattern_and_no_form(without_go, anna, annotator):
    for row in SemanticTemplate.objects.filter(grammar__world=without_go):
        delete(row, annotator, row.version)
    page = anna.get(NEW, {"command": "locate the <object>"})
    assert page.context["form"]["pattern"].value() == "$vbfind the {kobject}"
    assert page.context["suggestions"] == []
    assert 'hx-post="/w/home/templates/suggestions/' in page.content.decode()


@pytest.mark.parametrize("command", ["sing", "go to \0 the", "<room>", "(" * 300, "a " * 2000])
def test_any_command_opens_the_page(sample, anna, command):
    assert anna.get(NEW, {"command": command, "task_category": "\0"}).status_code == 200


def test_forms_are_suggested_for_the_typed_pattern(sample, anna):
    page = anna.post("/w/home/templates/suggestions/", {"pattern": "fly to the {room}"})
    assert page.context["suggestions"][0].text == "(go {room})"
    unreadable = anna.post("/w/home/templates/suggestions/", {"pattern": "fly to the {room"})
    assert unreadable.status_code == 200 and not unreadable.context["suggestions"]
    assert 'type="radio"' not in unreadable.content.decode()


@pytest.fixture
def without_all(sample, annotator) -> World:
    """The sample world without its templates; its three commands have no form."""
    for row in SemanticTemplate.objects.filter(grammar__world=sample.world):
        delete(row, annotator, row.version)
    return sample.world


def save_and_go_on(client, world, command: str, **values: str):
    sent = {
        "pattern": command.replace("<room>", "{room}").replace("<object>", "{kobject}"),
        "form": "UNKNOWN",
        "status": "ready",
        "task_category": world.grammar.task_categories.get().pk,
        "next": "",
        **values,
    }
    return client.post(f"{NEW}?command={quote(command)}", sent)


def next_of(answer) -> str:
    """Return the command that the page is for to which a save leads."""
    (command,) = parse_qs(urlsplit(answer.url).query)["command"]
    return command


def test_save_and_next_goes_through_all_commands_without_a_form(without_all, anna):
    first, second, third = commands_on(anna)
    answer = save_and_go_on(anna, without_all, second)
    assert answer.url.startswith(NEW) and next_of(answer) == third
    assert next_of(save_and_go_on(anna, without_all, third)) == first
    answer = save_and_go_on(anna, without_all, first)
    assert answer.url == PAGE and commands_on(anna) == []


def test_what_a_template_covers_is_not_the_next_command(without_all, anna):
    both = save_and_go_on(anna, without_all, "find the <object>", pattern="$vbfind the {kobject}")
    assert next_of(both) == "go to the <room>"


def test_a_draft_covers_nothing(without_all, anna):
    args = {"pattern": "$vbfind the {kobject}", "status": "draft"}
    answer = save_and_go_on(anna, without_all, "find the <object>", **args)
    assert next_of(answer) == "locate the <object>"


def test_a_message_after_save_and_next_leads_back_to_the_template(without_all, anna):
    answer = save_and_go_on(anna, without_all, "go to the <room>")
    made = SemanticTemplate.objects.get()
    assert f'href="/w/home/templates/{made.pk}/"' in str(*anna.get(answer.url).context["messages"])


def test_an_edit_goes_on_with_the_first_command_without_a_form(without_go, anna):
    row = SemanticTemplate.objects.get()
    values = {"pattern": row.pattern, "form": row.form, "status": "ready", "version": row.version}
    answer = anna.post(f"/w/home/templates/{row.pk}/", {**values, "next": ""})
    assert next_of(answer) == "go to the <room>"
