"""What pages say of a corpus as a whole, and of the people who work on it."""

from __future__ import annotations

import pytest

from annotations.generation.freezing import freeze_split
from annotations.generation.generating import generate_pairs
from annotations.labelling.collecting import collect
from annotations.labelling.enqueuing import refill, set_share
from annotations.labelling.item_answers import answer
from annotations.models import SemanticTemplate, Utterance, WorkKind

HOME = "worlds/home/"


@pytest.fixture
def read(call_as, reviewer):
    """A function: what a reviewer gets, with a token that only reads."""
    return lambda path: call_as(reviewer, "get", HOME + path, scope="read")


def test_complexity_is_that_of_the_page(read, tiny_world, adam):
    generate_pairs(tiny_world)
    columns = read("complexity/").json()["results"]
    shown = adam.get("/w/home/commands/complexity/").context["columns"]
    assert [each["commands"] for each in columns] == [each.commands for each in shown]
    assert columns[-1]["mean_form_length"] == shown[-1].mean_form_length


def test_what_has_no_form_is_listed(read, tiny_world):
    SemanticTemplate.objects.filter(pattern__startswith="$vbfind").delete()
    generate_pairs(tiny_world)
    report = read("uncovered/").json()
    texts = {each["text"] for each in report["results"]}
    assert texts == {"find the <object>", "locate the <object>"}
    assert report["count"] == 2
    assert {each["nonterminal"]: each["uncovered"] for each in report["shares"]} == {
        "object": 2,
        "vbfind": 2,
    }
    assert read("uncovered/?q=locate").json()["count"] == 1
    assert read("uncovered/?task_category=moon").status_code == 400


def test_templates_that_disagree_or_make_nothing_are_listed(read, tiny_world):
    first = SemanticTemplate.objects.get(pattern__startswith="go to")
    other = SemanticTemplate.objects.create(
        grammar=first.grammar,
        source=first.source,
        task_category=first.task_category,
        position=9,
        pattern="go to the {room}",
        form="(walk {room})",
        status="ready",
    )
    generate_pairs(tiny_world)
    (pair,) = read("conflicts/").json()["results"]
    assert (pair["kept"], pair["lost"], pair["count"]) == (other.pk, first.pk, 1)
    makes = read("templates/?makes=nothing").json()["results"]
    assert [each["id"] for each in makes] == [first.pk]
    assert read("templates/?makes=outside").json()["results"] == []


def test_a_split_says_what_leaks_and_what_has_changed(read, tiny_world):
    generate_pairs(tiny_world)
    split = freeze_split(tiny_world, "first", "command")
    leaks = read(f"splits/{split.pk}/near-duplicates/").json()["results"]
    assert {each["part"] for each in leaks} <= {"validation", "test"}
    assert all(len(each["examples"]) <= each["pairs"] for each in leaks)
    same = read(f"splits/{split.pk}/changes/").json()
    assert same["relabelled"] == []
    SemanticTemplate.objects.filter(pattern__startswith="go to").delete()
    generate_pairs(tiny_world)
    changed = read(f"splits/{split.pk}/changes/").json()
    assert sum(each["removed"] for each in changed["parts"]) == 1


def test_agreement_and_progress_are_those_of_the_pages(
    read, tiny_world, annotator, admin, reviewer
):
    assert read("agreement/").json()["overall"]["alpha"]["value"] is None
    collect(tiny_world, ["bring me tea"], by=annotator)
    set_share(tiny_world, WorkKind.UNLABELLED, 100)
    refill(tiny_world)
    row = Utterance.objects.get()
    for person, form in ((annotator, "(go 1)"), (admin, "(go 2)")):
        answer(row, "form", form, person, row.version)
    report = read("agreement/").json()
    assert (report["overall"]["items"], report["overall"]["exact_match"]["value"]) == (1, 0)
    assert report["disagreements"] == []  # a third person is still asked
    row.refresh_from_db()
    answer(row, "form", "(go 2)", reviewer, row.version)
    report = read("agreement/").json()
    assert [each["example"] for each in report["disagreements"]] == ["bring me tea"]
    progress = read("progress/").json()
    assert [(each["person"], each["total"]) for each in progress["people"]] == [
        ("adam", 1),
        ("anna", 1),
        ("rene", 1),
    ]


def test_a_part_is_downloaded(read, tiny_world):
    part = read("download/ontology/")
    assert (part.status_code, part["Content-Type"]) == (200, "application/zip")
    assert read("download/moon/").status_code == 404
