"""By example: lines become a proposal, corrections rewrite them, one can try them, and one button stores them."""

from __future__ import annotations

import re

import pytest

from annotations.language.induction import MOST_LINES
from annotations.models import AuditEntry, Predicate, SemanticTemplate, TaskCategory

PAGE = "/w/home/examples/"
PREVIEW, TRY = f"{PAGE}preview/", f"{PAGE}try/"
ROUTES = "worlds/home"
LINES = "water the [tomatoes] in [bed two](bed)\nwater the [roses]\nirrigate the [roses]"
NAMED = "water the [tomatoes](plant) in [bed two](bed)\nwater the [roses](plant)\nirrigate the [roses](plant)"
JOINED = f"{NAMED} = water"


def rewritten(response) -> str:
    found = re.search(r"data-rewritten[^>]*>\n(.*?)</textarea>", response.content.decode(), re.S)
    return found[1] if found else ""


@pytest.mark.parametrize(
    "sent, lines",
    [
        ({"change": "class", "of": "thing", "name": "Plant"}, NAMED),
        ({"change": "class", "of": "thing", "name": "3"}, ""),
        ({"change": "class", "of": "nothing", "name": "plant"}, ""),
        ({"change": "predicate", "of": "irrigate", "name": "water"}, f"{LINES} = water"),
        ({"change": "predicate", "of": "irrigate", "name": ""}, ""),
        (
            {"change": "add", "line": "# irrigate is not water"},
            f"{LINES}\n# irrigate is not water",
        ),
        (
            {"change": "add", "said": "water the tomatoes now"},
            f"{LINES}\nwater the [tomatoes] now",
        ),
        (
            {"change": "add", "offers": "order"},
            f"{LINES}\nin [bed two](bed), water the [tomatoes]",
        ),
        (
            {"change": "english", "of": "water", "gloss": " give  water to {1} | water {1} in {2}"},
            f"{LINES}\n# water: give water to {{1}} | water {{1}} in {{2}}",
        ),
        ({"change": "english", "of": "water", "gloss": "x" * 300}, ""),
        ({"change": "english", "of": "water", "gloss": ""}, ""),
        ({"change": "other"}, ""),
    ],
)
def test_a_correction_rewrites_the_lines(anna, sent, lines):
    response = anna.post(PREVIEW, {"lines": LINES, **sent})
    assert response.status_code == 200
    found = rewritten(response)
    assert found.partition(" = (")[0] == lines


def test_a_question_is_asked_until_it_is_answered(anna):
    asked = anna.post(PREVIEW, {"lines": NAMED}).content.decode()
    assert 'value="# water is not irrigate"' in asked
    for answer in ("# water is not irrigate", "# irrigate is not water"):
        said_no = anna.post(PREVIEW, {"lines": f"{NAMED}\n{answer}"}).content.decode()
        assert "doubts-title" not in said_no
    assert "doubts-title" not in anna.post(PREVIEW, {"lines": JOINED}).content.decode()


@pytest.mark.parametrize(
    "lines",
    [
        "",
        "water the [roses",
        "<b>bold</b> [<i>x</i>]",
        "מים [שלום]",
        "[a] " * 100,
        "\n".join(f"move [{n}] to [{n + 1}]" for n in range(2 * MOST_LINES)),
        "say ({|}) \\ $ [x]",
        "x" * 200_000,
    ],
)
def test_odd_lines_make_a_page(anna, lines):
    assert anna.post(PREVIEW, {"lines": lines}).status_code == 200
    assert anna.post(TRY, {"lines": lines, "said": "water <b> the roses"}).status_code == 200


def test_lines_are_tried_before_they_are_stored(anna):
    said = "water the roses in bed two"
    tried = anna.post(TRY, {"lines": JOINED, "said": [said, "sing"]}).content.decode()
    assert tried.count("<figure") == 1
    assert tried.count('name="said" value="sing"') == 2  # one to try again, one to make it a line
    assert tried.count(f'name="said" value="{said}"') == 1
    assert not SemanticTemplate.objects.exists()
    assert "<li>" in anna.post(TRY, {"lines": "", "said": said}).content.decode()


def test_one_button_stores(adam, world):
    response = adam.post(PAGE, {"lines": JOINED, "task_category": "commands", "once": "key"})
    assert (response.status_code, response.url) == (302, PAGE)
    assert TaskCategory.objects.get().name == "commands"
    assert world.utterances.labelled().count() == 3
    assert AuditEntry.objects.filter(what="store examples").count() == 1
    adam.post(PAGE, {"lines": JOINED, "task_category": "commands", "once": "key"})
    assert AuditEntry.objects.filter(what="store examples").count() == 2
    assert SemanticTemplate.objects.count() == 2
    again = adam.post(PREVIEW, {"lines": JOINED}).content.decode()
    assert "classes-title" in again and "example-templates" not in again


def test_what_is_no_example_stores_nothing(adam):
    refused = adam.post(PAGE, {"lines": LINES, "task_category": "commands"})
    assert refused.status_code == 422
    assert "tomatoes" in refused.content.decode()
    assert adam.post(PAGE, {"lines": "x" * 200_000}).status_code == 422
    assert not SemanticTemplate.objects.exists()


def test_a_program_reads_the_proposal_and_stores_it(call_as, annotator, admin, world):
    sent = {"lines": LINES.splitlines()}
    answer = call_as(annotator, "post", f"{ROUTES}/proposals/", sent)
    assert answer.status_code == 200
    found = answer.json()
    assert [(each["token"], each["is_named"]) for each in found["classes"]] == [
        ("thing", False),
        ("bed", True),
    ]
    assert found["doubts"][0]["comment"] == "# water is not irrigate"
    assert {each["kind"] for each in found["offers"]} == {"order"}
    refused = call_as(annotator, "post", f"{ROUTES}/examples/", sent)
    assert (refused.status_code, refused.json()["code"]) == (400, "no_examples")
    assert refused.json()["problems"][0]["line"] == 1
    stored = call_as(admin, "post", f"{ROUTES}/examples/", {"lines": JOINED.splitlines()})
    assert stored.status_code == 201
    found = stored.json()
    assert world.uploads.get().pk == found.pop("upload")
    assert found == {
        **{"classes": 2, "entities": 3, "predicates": 1, "changed": 0},
        **{"productions": 3, "templates": 2, "utterances": 3, "lengthened": 0},
    }
    known = call_as(annotator, "post", f"{ROUTES}/proposals/", {"lines": JOINED.splitlines()})
    assert known.json()["understood"] == [1, 2, 3] and known.json()["templates"] == []


def test_a_change_of_what_is_stored_is_shown_and_can_be_refused(adam, world):
    adam.post(PAGE, {"lines": JOINED})
    later = "sprinkle the [roses] = water"
    shown = adam.post(PREVIEW, {"lines": later}).content.decode()
    assert "changes-title" in shown
    for text in ("$water = water | irrigate", "$water = water | irrigate | sprinkle"):
        assert f"<code>{text}</code>" in shown
    (comment,) = re.findall(r'name="line" value="(# sprinkle [^"]*)"', shown)
    refused = adam.post(PREVIEW, {"lines": later, "change": "add", "line": comment})
    assert rewritten(refused) == f"{later}\n# sprinkle is not $water"
    assert "changes-title" not in refused.content.decode()
    tried = adam.post(TRY, {"lines": later, "said": "sprinkle the tomatoes in bed two"})
    assert "<figure" in tried.content.decode()
    before = SemanticTemplate.objects.count()
    adam.post(PAGE, {"lines": later})
    assert SemanticTemplate.objects.count() == before


def test_a_program_reads_and_refuses_a_change(call_as, admin, world):
    call_as(admin, "post", f"{ROUTES}/examples/", {"lines": JOINED.splitlines()})
    later = ["sprinkle the [roses] = water"]
    answer = call_as(admin, "post", f"{ROUTES}/proposals/", {"lines": later}).json()
    (change,) = answer["changes"]
    assert change["phrases"] == ["sprinkle"] and change["old"] == "$water"
    assert change["edits"] == [
        {
            "kind": "production",
            "before": "$water = water | irrigate",
            "after": "$water = water | irrigate | sprinkle",
        }
    ]
    sent = {"lines": [*later, *change["comments"]]}
    assert not call_as(admin, "post", f"{ROUTES}/proposals/", sent).json()["changes"]
    stored = call_as(admin, "post", f"{ROUTES}/examples/", {"lines": later}).json()
    assert (stored["lengthened"], stored["templates"], stored["productions"]) == (1, 0, 0)


def test_english_is_written_into_the_lines_and_stored(call_as, adam, admin, world):
    english = "# water: give water to {1} | give water to {1} in {2}"
    sent = {"change": "english", "of": "water", "gloss": "wet {1}"}
    again = adam.post(PREVIEW, {"lines": f"{JOINED}\n{english}", **sent})
    assert rewritten(again) == f"{JOINED}\n# water: wet {{1}}"
    named = {"change": "predicate", "of": "water", "name": "sprinkle"}
    renamed = rewritten(adam.post(PREVIEW, {"lines": f"{LINES}\n{english}", **named}))
    assert renamed.endswith(english.replace("# water", "# sprinkle"))
    lines = [*JOINED.splitlines(), english]
    answer = call_as(admin, "post", f"{ROUTES}/proposals/", {"lines": lines}).json()
    assert answer["predicates"][0]["gloss"] == "give water to {1} | give water to {1} in {2}"
    long = [*JOINED.splitlines(), f"# water: {'wet ' * 60}"]
    problems = call_as(admin, "post", f"{ROUTES}/proposals/", {"lines": long}).json()["problems"]
    assert [each["line"] for each in problems] == [4]
    call_as(admin, "post", f"{ROUTES}/examples/", {"lines": lines})
    assert Predicate.objects.get().gloss == "give water to {1} | give water to {1} in {2}"


def test_english_of_the_world_grows_with_its_arguments(adam, world):
    adam.post(PAGE, {"lines": "water the [roses](plant)\n# water: wet {1}"})
    adam.post(PAGE, {"lines": "water the [roses]\n# water: something else"})
    assert Predicate.objects.get().gloss == "something else"
    adam.post(PAGE, {"lines": "water the [roses] in [bed two](bed)"})
    assert Predicate.objects.get().gloss == "something else | water {1} in {2}"
    assert Predicate.objects.get().signatures == [["plant"], ["plant", "bed"]]


def test_only_so_many_lines_are_sent(call_as, annotator):
    sent = {"lines": ["stop"] * (MOST_LINES + 1)}
    assert call_as(annotator, "post", f"{ROUTES}/proposals/", sent).status_code == 400


def test_readers_are_refused(rene, world):
    assert rene.get(PAGE).status_code == 403
