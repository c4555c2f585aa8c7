"""What grammar and templates ask for that no entity of the world is."""

from __future__ import annotations

import pytest

from annotations.generation.entity_check import entity_problems
from annotations.language.grammar import Grammar, read_production
from annotations.language.templates import TaskCategory, make_template
from annotations.language.texts.errors import Position
from annotations.language.world import (
    ArgumentKind,
    Entity,
    Ontology,
    Predicate,
    PredicateKind,
    Signature,
)

HOME = Ontology(
    (
        Entity("object", "tea", (), {"category": "drinks", "canPour": "true"}),
        Entity("category", "drinks", (), {"singular": "drink"}),
        Entity("location", "sofa", (), {"isPlacement": "true"}),
        Entity("room", "kitchen"),
        Entity("name", "Ada"),
    )
)
IS_A = Predicate(
    "is_a",
    PredicateKind.DESCRIPTION,
    (Signature((ArgumentKind.VARIABLE, "object")),),
)


def places(productions: list[str] = (), templates: list[tuple[str, str]] = ()):
    lines = [read_production(line, Position("g.txt", at)) for at, line in enumerate(productions, 1)]
    pairs = [make_template(*pair, Position("t.txt", at)) for at, pair in enumerate(templates, 1)]
    category = TaskCategory("1", Grammar(tuple(lines)), tuple(pairs))
    problems = entity_problems([category], HOME, {"is_a": IS_A})
    return [(each.position.source, each.position.line) for each in problems]


@pytest.mark.parametrize(
    "wildcard",
    ["{object}", "{kobject 1}", "{placement}", "{room?}", "{name female}", "{category}",
     "{kobject where canPour = true}", "{placement where room = {room}}", "{void}", "{pron}"],
)  # fmt: skip
def test_what_an_entity_fits_is_no_problem(wildcard):
    assert places([f"$Main = take {wildcard}"]) == []


@pytest.mark.parametrize(
    "wildcard",
    ["{gesture}", "{question}", "{aobject}", "{male 2}", "{beacon}", "{whattosay}",
     "{kobject where canPour = false and fruit = true}", "{void meta: ask {question}}"],
)  # fmt: skip
def test_what_no_entity_fits_is_said_where_it_is_asked_for(wildcard):
    assert places(["$Main = go", f"$Main = take {wildcard}"]) == [("g.txt", 2)]


def test_one_kind_of_wildcard_is_said_once():
    lines = ["$Main = $a", "$a = wave a {gesture 1}", "$a = see the {gesture?}"]
    templates = [("wave a {gesture}", "(wave {gesture})")]
    assert places(lines, templates) == [("g.txt", 2)]


@pytest.mark.parametrize(
    ("form", "is_missing"),
    [
        ('(find (λ$1:e (is_a $1 "tea")))', False),
        ('(find (λ$1:e (is_a $1 "Drink")))', False),
        ('(find (λ$1:e (is_a $1 "<object>")))', False),
        ('(find (λ$1:e (is_a $1 "cereal")))', True),
        ('(say "hello there")', False),  # nothing says that it should be an entity
    ],
)
def test_a_text_where_an_entity_belongs(form, is_missing):
    assert places(templates=[("find it", form)]) == [("t.txt", 1)] * is_missing
