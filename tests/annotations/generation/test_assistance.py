"""What the editor is told while somebody types."""

from __future__ import annotations

import pytest

SENT = {"pattern": "$vbfind the {kobject}", "form": "(find (λ$1:e (is_a $1 {kobject})))"}


@pytest.fixture
def ask(sample, anna):
    category = sample.world.grammar.task_categories.get()
    fixed = {"task_category": category.pk, "status": "ready"}
    return lambda **texts: anna.post("/w/home/templates/check/", {**fixed, **SENT, **texts}).json()


def apply(edits, field, text):
    for edit in sorted(edits, key=lambda each: each["from"], reverse=True):
        if edit["field"] == field:
            text = text[: edit["from"]] + edit["text"] + text[edit["to"] :]
    return text


def test_a_problem_comes_with_the_edits_that_repair_it(ask):
    form = "(fnd (λ$1:e (is_a $1 {kobject})))"
    (problem,) = ask(form=form)["problems"]
    assert (problem["field"], problem["at"]) == ("form", 1)
    assert apply(problem["repairs"][0]["edits"], "form", form) == SENT["form"]


def test_a_slot_that_is_left_out_goes_where_the_templates_of_the_world_have_it(ask):
    form = "(find (λ$1:e (thing $1)))"
    problem = next(
        each for each in ask(form=form)["problems"] if "leaves it out" in each["message"]
    )
    assert [each["label"] for each in problem["repairs"]] == [
        "Add (is_a $1 {kobject}) in front of (thing $1)"
    ]


def test_a_slot_has_its_places_on_both_sides(ask):
    (slot,) = ask()["slots"]
    assert [SENT["pattern"][slice(*each)] for each in slot["pattern"]] == ["{kobject}"]
    assert [SENT["form"][slice(*each)] for each in slot["form"]] == ["{kobject}"]


def test_a_wildcard_stands_where_a_nonterminal_produces_it(ask):
    pattern = "$vbfind the $object"
    (slot,) = ask(pattern=pattern)["slots"]
    assert [pattern[slice(*each)] for each in slot["pattern"]] == ["$object"]


def test_offsets_count_as_browsers_do(ask):
    form = '(say "🙂"\r\n  (fnd {kobject}))'
    problem = next(each for each in ask(form=form)["problems"] if "fnd" in each["message"])
    assert problem["at"] == len('(say "xx"\n  (')
    assert (problem["line"], problem["column"]) == (2, 4)


def test_the_layout_is_the_printer_s(ask):
    answer = ask(pattern="$vbfind   the {kobject }", form='(find(λ $1 e.(is_a $1 "tea")))')
    assert answer["formatted"] == {
        "pattern": "$vbfind the {kobject}",
        "form": '(find (λ$1:e (is_a $1 "tea")))',
    }


@pytest.fixture
def completion(sample, anna):
    category = sample.world.grammar.task_categories.get()
    url = f"/w/home/templates/completion/{category.pk}/"
    return lambda **headers: anna.get(url, headers=headers)


def texts(offers):
    return [each["text"] for each in offers]


def test_what_can_be_written_is_offered_with_what_it_is(completion, sample):
    answer = completion().json()
    assert texts(answer["nonterminals"]) == ["$Main", "$object", "$vbfind"]
    assert answer["nonterminals"][2]["detail"] == "find | locate"
    assert {"{kobject}", "{room}", "{gesture}"} <= set(texts(answer["wildcards"]))
    find = next(each for each in answer["predicates"] if each["text"] == "find")
    assert find["detail"] == "(lambda)"
    assert "find {1}" in find["info"]


def test_a_browser_is_told_whether_the_offers_have_changed(completion, sample):
    tag = completion().headers["ETag"]
    assert completion(**{"If-None-Match": tag}).status_code == 304
    sample.world.predicates.filter(name="find").update(gloss="look for {1}")
    changed = completion(**{"If-None-Match": tag})
    assert changed.status_code == 200
    assert "look for {1}" in changed.content.decode()


def declaration_in(answer):
    return next(filter(None, (each["declaration"] for each in answer["problems"])), None)


@pytest.mark.parametrize(
    ("form", "kind", "signatures"),
    [
        ('(guide {kobject} "sofa" 3)', "action", [["object", "text", "number"]]),
        ("(find (λ$1:e (guide $1 {kobject})))", "description", [["variable", "object"]]),
        ("(find (λ$1:e (is_a $1 {kobject}) (guide $1)))", "description", [["variable"]]),
    ],
)
def test_a_missing_predicate_comes_with_its_declaration(form, kind, signatures, ask, anna):
    wanted = {"name": "guide", "kind": kind, "signatures": signatures}
    assert declaration_in(ask(form=form)) == wanted
    route = "/api/v1/worlds/home/predicates/"
    assert anna.post(route, wanted, content_type="application/json").status_code == 201
    assert declaration_in(ask(form=form)) is None


def test_what_a_nonterminal_stands_for_shows_in_the_declaration(ask):
    answer = ask(pattern="$vbfind the $object", form="(guide $object)")
    assert declaration_in(answer)["signatures"] == [["object"]]


def test_nothing_is_declared_for_a_declared_predicate_or_an_unreadable_form(ask):
    assert declaration_in(ask(form="(find {kobject} {kobject})")) is None
    assert declaration_in(ask(form="(guide {kobject}")) is None
