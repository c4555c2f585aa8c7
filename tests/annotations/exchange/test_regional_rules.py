"""What the rules of a region have of their own is added by rows, as docs/guides/editing-the-world.md says."""

from __future__ import annotations

import pytest

from annotations.exchange.generator_import import import_generator
from annotations.exchange.shipped_worlds import SHIPPED_WORLDS
from annotations.language.forms import read_form
from annotations.language.plans import apply_recipes, default_book, make_plan, spoken, usual_places
from annotations.language.world import check_form, gloss
from annotations.models import World
from annotations.rows.from_rows import ontology_of, predicates_of, task_categories
from parser_service.parsers.interface import Knowledge
from parser_service.parsers.oracle import GrammarOracle

ROWS = [
    ("productions", {"nonterminal": "trait", "expansion": "age", "source": "kinds.txt"}),
    (
        "predicates",
        {
            "name": "age",
            "kind": "description",
            "signatures": [["variable", "variable"]],
            "gloss": "_ of the age {2}",
        },
    ),
    ("entities", {"entity_class": "pose", "text": "squatting", "aliases": ["squatting down"]}),
    ("entities", {"entity_class": "colour", "text": "purple", "aliases": []}),
    ("entities", {"entity_class": "garment", "text": "kimono", "aliases": []}),
    ("entities", {"entity_class": "topic", "text": "your favourite drink", "aliases": []}),
]
# What is said → its form, and what the robot says that it will do.
SAID = {
    "tell me the age of the person at the bar counter": (
        "( say ( lambda $1 e ( lambda $2 e ( person $2 ) ( age $2 $1 ) ( at $2 “bar counter” ) ) ) )",
        "I will go to the bar counter, find the person, find out their age, come back to you, and tell you their age.",
    ),
    "what is the age of Maria": (
        "( say ( lambda $1 e ( lambda $2 e ( person $2 ) ( age $2 $1 ) ( name $2 “Maria” ) ) ) )",
        "I will find Maria, find out their age, and tell you their age.",
    ),
    "follow the squatting person": (
        "( follow ( lambda $1 e ( person $1 ) ( pose $1 “squatting” ) ) )",
        "I will find the person who is squatting and follow them.",
    ),
    "find a person in a purple kimono": (
        "( find ( lambda $1 e ( person $1 ) ( wears $1 “purple” “kimono” ) ) )",
        "I will find the person in a purple kimono.",
    ),
    "Tell the person squatting down in the lobby your favourite drink.": (
        "( say “your favourite drink” "
        "( lambda $1 e ( person $1 ) ( pose $1 “squatting” ) ( at $1 “lobby” ) ) )",
        "I will go to the lobby, find the person who is squatting, and tell them my favourite drink.",
    ),
}


@pytest.fixture
def club(db) -> World:
    assert not import_generator("club", SHIPPED_WORLDS["competition"].folder).is_refused
    return World.objects.get(name="club")


def understood(world: World, said: str) -> str:
    """The form of the best answer, with the entities in typographic quotation marks; empty for none."""
    knowledge = Knowledge(ontology=ontology_of(world), grammar=task_categories(world))
    for best in GrammarOracle(knowledge=knowledge).predict([said])[0]:
        form = best.form
        for value in best.values:
            form = form.replace(f'" <{form.split("<")[1].split(">")[0]}> "', f"“{value}”", 1)
        return form
    return ""


def test_a_trait_a_pose_and_a_topic_are_a_row_each(club, call_as, superuser):
    assert not any(understood(club, said) for said in SAID)
    for noun, sent in ROWS:
        assert call_as(superuser, "post", f"worlds/club/{noun}/", sent).status_code == 201
    ontology, predicates = ontology_of(club), predicates_of(club)
    for said, (wanted, robot_says) in SAID.items():
        assert understood(club, said) == wanted
        form = read_form(wanted.replace("“", '"').replace("”", '"'))
        assert check_form(form, predicates) == []
        assert gloss(form, predicates, ontology.classes)
        plan = make_plan(form, ontology, predicates)
        assert plan.is_executable
        robot = apply_recipes(plan, default_book(), usual_places(ontology))
        assert spoken(robot) == robot_says
