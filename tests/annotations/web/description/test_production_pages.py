"""Productions are edited in place: checked, sampled, and their consequences shown before saving."""

from __future__ import annotations

import pytest
from django.urls import reverse

from annotations.editing.edits import change
from annotations.models import Production, World


@pytest.fixture
def find(sample) -> Production:
    return Production.objects.get(nonterminal="vbfind")


def commands(world):
    return set(world.commands.values_list("anonymized_text", flat=True))


def test_a_saved_production_brings_the_commands_up_to_date(find, anna, world):
    before = commands(world)
    sent = {"expansion": "find  | locate | seek", "version": 1}
    assert anna.post(f"/w/home/grammar/{find.pk}/", sent).status_code == 302
    assert commands(world) - before == {"seek the <object>"}
    assert not World.objects.get(pk=world.pk).commands_are_stale
    find.refresh_from_db()
    assert (find.expansion, find.version) == ("find | locate | seek", 2)


def test_lines_of_templates_stand_with_the_nonterminal_that_they_are_for(sample, find, anna):
    templates = sample.world.grammar.templates
    first = templates.get(pk=sample.template.pk)
    lines = [
        templates.create(source=first.source, pattern=text, form="(find)", position=position)
        for position, text in enumerate(
            ("$vbfind -> seek", " $vbfind->hunt", "$vbfind2 -> x"), start=80
        )
    ]
    assert [each.nonterminal for each in lines] == ["vbfind", "vbfind", "vbfind2"]
    page = anna.get(f"/w/home/grammar/{find.pk}/")
    assert list(page.context["meanings"]) == lines[:2]
    listed = anna.get("/w/home/templates/?nonterminal=vbfind").context["listing"]
    assert list(listed.rows) == lines[:2]
    assert first.nonterminal == ""


def test_consequences_are_shown_before_saving(find, anna, world):
    before = commands(world)
    sent = {"expansion": "find | seek"}
    address = f"/w/home/grammar/preview/?row={find.pk}"
    answer = anna.post(address, sent)
    changes = answer.context["expected"].changes
    assert [each.command for each in changes.covered_in_grammar] == ["seek the <object>"]
    assert [each.command for each in changes.lost] == ["locate the <object>"]
    assert "<li>seek</li>" in answer.content.decode()
    assert commands(world) == before
    assert "expected" not in anna.post(address, {"expansion": "find ("}).context


@pytest.mark.parametrize(
    ("expansion", "named", "column", "severity"),
    [
        ("find ($gone", "", 6, "error"),
        ("find $gone", "$gone", 1, "warning"),
        ("find $vbfind", "$vbfind → $vbfind", 1, "error"),
    ],
)
def test_the_checker_answers_while_one_types(find, anna, expansion, named, column, severity):
    address = f"/w/home/grammar/check/?row={find.pk}"
    (problem,) = anna.post(address, {"expansion": expansion}).json()["problems"]
    assert (problem["severity"], problem["column"]) == (severity, column)
    assert named in problem["message"]
    saved = anna.post(f"/w/home/grammar/{find.pk}/", {"expansion": expansion, "version": 1})
    assert (saved.status_code == 200) == (severity == "error")


def test_the_problems_of_the_grammar_follow_what_is_saved(find, anna, world):
    anna.post(f"/w/home/grammar/{find.pk}/", {"expansion": "find $gone", "version": 1})
    assert world.problems.filter(subject="grammar", message__contains="$gone").count() == 1
    anna.post(f"/w/home/grammar/{find.pk}/", {"expansion": "find", "version": 2})
    assert not world.problems.filter(subject="grammar", message__contains="$gone").exists()


def test_a_line_is_added_and_deleted_again(sample, anna, world):
    before = commands(world)
    sent = {"nonterminal": "$vbfind", "expansion": "seek", "source": "common_rules.txt"}
    answer = anna.post("/w/home/grammar/new/", {**sent, "once": "k"})
    row = Production.objects.get(expansion="seek")
    assert answer.url == f"/w/home/grammar/{row.pk}/"
    assert row.nonterminal == "vbfind"
    assert "seek the <object>" in commands(world)
    delete = reverse("delete_row", kwargs={"world": "home", "kind": "production", "pk": row.pk})
    anna.post(delete, {"version": 1})
    assert commands(world) == before


def test_two_people_on_one_production_get_a_merge(find, anna, admin):
    change(find, {"expansion": "find | locate | spot"}, admin, 1)
    sent = {"expansion": "find | locate | seek", "version": 1}
    answer = anna.post(f"/w/home/grammar/{find.pk}/", sent)
    assert answer.status_code == 409
    assert "find | locate | spot" in answer.content.decode()
    sent = {"expansion": "find | locate | spot | seek", "version": 2}
    assert anna.post(f"/w/home/grammar/{find.pk}/", sent).status_code == 302
    assert Production.objects.get(pk=find.pk).version == 3


def test_those_who_may_not_write_read_it(find, rene):
    page = rene.get(f"/w/home/grammar/{find.pk}/").content.decode()
    assert "find | locate" in page
    assert "production-form" not in page
