from __future__ import annotations

from collections import Counter

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.texts.errors import Position, Severity
from annotations.language.world import Entity, Ontology, read_ontology, write_ontology
from tests.annotations.language.ontology_files import read_ontology_folder
from tests.annotations.language.published import SHARED, needs_corpus

OBJECTS = """<?xml version="1.0"?>
<categories>
    <category name="drinks" defaultLocation="shelf" room="cellar">
        <object name="cold  tea" difficulty="hard" canPour="true" aliases="iced tea; tea"/>
    </category>
    <category name="drinks" defaultLocation="shelf" room="cellar"/>
</categories>
"""
LOCATIONS = """<rooms>
    <room name="cellar"><location name="shelf" isPlacement="true"/></room>
    <room name="attic"><location name="shelf" isBeacon="yes"/><location name="shelf"/></room>
</rooms>"""


def read(**files: str) -> tuple[Ontology, list[str]]:
    named = {name.replace("_", "."): text.encode() for name, text in files.items()}
    ontology, problems = read_ontology(named)
    return ontology, [str(problem) for problem in problems]


def test_rows_keep_their_attributes_aliases_and_places() -> None:
    ontology, _ = read(objects_xml=OBJECTS)
    category, item, again = ontology.entities
    assert category == Entity(
        "category", "drinks", (), {"defaultLocation": "shelf", "room": "cellar"}
    )
    assert item.text == "cold tea"
    assert item.aliases == ("iced tea", "tea")
    assert item.attribute("CANPOUR") == "true" and item.is_set("canPour")
    assert item.attribute("category") == "drinks" and item.attribute("Name") == "cold tea"
    assert item.position == Position("objects.xml", 4, 9)
    assert again == category and hash(again) == hash(category)


def test_a_location_may_repeat_in_another_room_but_not_in_its_own() -> None:
    ontology, problems = read(locations_xml=LOCATIONS)
    assert len(ontology.of_class("location")) == 3
    assert any("shelf occurs more than once in the attic" in each for each in problems)
    assert any("the isBeacon of shelf is yes" in each for each in problems)
    assert len(problems) == 2


def test_singulars_come_from_the_table_with_stray_spaces() -> None:
    ontology, problems = read(
        objects_xml=OBJECTS, categories_txt="name plural, name singular\ndrinks ,  drink\ntoys, toy"
    )
    assert ontology.singular("drinks") == "drink"
    assert ontology.singular("shoes") == "shoes"
    assert ontology.of_class("category")[-1].text == "toys"
    assert "categories.txt:3:1: warning: no object is of the category toys" in problems[0]


@pytest.mark.parametrize(
    ("file", "text", "place", "named"),
    [
        ("objects_xml", OBJECTS, "objects.xml:4:9: warning: ", "cold tea"),
        ("objects_xml", "<names/>", "objects.xml:1:1: error: ", "<names>"),
        ("objects_xml", "", "objects.xml:1:1: error: ", ""),
        ("objects_xml", "<categories>\n <category>", "objects.xml:2:12: error: ", ""),
        (
            "objects_xml",
            "<categories>\n <cat/></categories>",
            "objects.xml:2:2: warning: ",
            "<cat>",
        ),
        ("objects_xml", "<categories><category/></categories>", ":1:13: error: ", "<category>"),
        ("objects_xml", "<a>" * 5000, "objects.xml:", " 64 "),
        ("names_xml", "<names><name> </name></names>", "names.xml:1:8: error: ", ""),
        ("names_xml", '<names><name gender="f">A</name></names>', ": warning: ", " A "),
        ("questions_xml", "<questions><question/></questions>", ":1:12: error: ", ""),
        ("categories_txt", "drinks, drink", "categories.txt:1:1: error: ", ""),
        ("categories_txt", "plural, singular\n\nx", "categories.txt:3:1: error: ", ""),
        ("whattosay_txt", "<sayings/>", "whattosay.txt:1:1: error: ", "XML"),
    ],
)
def test_what_is_wrong_is_said_with_its_place(file: str, text: str, place: str, named: str) -> None:
    _, problems = read(**{file: text})
    assert place in problems[0] and named in problems[0].partition(place)[2]


@pytest.mark.parametrize(
    "declaration",
    [
        '<!DOCTYPE c [\n<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]>',
        '<!DOCTYPE c [\n<!ENTITY a SYSTEM "file:///etc/passwd">]>',
        '<!DOCTYPE c\nSYSTEM "http://example.org/c.dtd">',
    ],
)
def test_entity_bombs_and_external_entities_are_refused(declaration: str) -> None:
    ontology, problems = read(objects_xml=f"{declaration}<categories>&a;</categories>")
    assert not ontology.entities
    assert problems[0].startswith("objects.xml:2:") and ": error: " in problems[0]


def test_utf16_text_is_refused_with_a_hint() -> None:
    _, (problem,) = read_ontology({"whattosay.txt": "a joke".encode("utf-16")})
    assert problem.severity == Severity.ERROR
    assert "UTF-16" in problem.message and problem.hint


def test_a_missing_default_location_is_a_warning() -> None:
    text = OBJECTS.replace('"shelf"', '"cupboard"').replace('room="cellar"/', 'room="garage"/')
    _, problems = read(objects_xml=text, locations_xml=LOCATIONS)
    assert any(
        "the default location cupboard of drinks does not exist" in each for each in problems
    )
    assert any("the room garage of the category drinks does not exist" in each for each in problems)


def test_writing_and_reading_again_gives_the_same_rows() -> None:
    ontology, _ = read(
        objects_xml=OBJECTS,
        locations_xml=LOCATIONS,
        names_xml='<names><name>Bo</name><name gender="Male" aliases="Bobby">Bo</name></names>',
        gestures_xml='<gestures><gesture name="waving &lt;3" difficulty="easy"/></gestures>',
        questions_xml="<questions><question><q>1 &amp; 1?</q><a>2</a></question></questions>",
        whattosay_txt="a joke\n\nthe time",
        categories_txt="plural, singular\ndrinks, drink\ntoys, toy",
    )
    files = {name: text.encode() for name, text in write_ontology(ontology).items()}
    again, _ = read_ontology(files)
    assert again.entities == ontology.entities
    assert len(files) == 7


TEXT = st.text(st.sampled_from("aé<&\"' é;"), min_size=1).map(str.split).map(" ".join).filter(bool)


@given(st.lists(st.tuples(TEXT, st.lists(TEXT, max_size=3)), max_size=4))
def test_any_text_survives_being_written(rooms: list[tuple[str, list[str]]]) -> None:
    entities: list[Entity] = []
    for room, places in rooms:
        entities.append(Entity("room", room))
        entities += [Entity("location", place, (), {"room": room}) for place in places]
    files = {k: v.encode() for k, v in write_ontology(Ontology(tuple(entities))).items()}
    assert read_ontology(files)[0].entities == tuple(entities)


@needs_corpus
@pytest.mark.parametrize("year", ["2018", "2019"])
def test_the_real_ontologies_have_the_rows_to_expect(year: str) -> None:
    ontology, problems = read_ontology_folder(SHARED / f"generator-{year}")
    counts = Counter(entity.entity_class for entity in ontology.entities)
    assert counts == {
        "object": 39,
        "category": 9,
        "location": 36,
        "room": 6,
        "name": 20,
        "gesture": 5,
        "question": 16,
        "whattosay": 5,
    }
    assert len({entity.text for entity in ontology.of_class("category")}) == 8
    assert len({entity.text for entity in ontology.of_class("name")}) == 10
    assert ontology.singular("cutlery") == "utensil"
    assert [str(problem.position) for problem in problems] == ["objects.xml:50:5"]
    files = {name: text.encode() for name, text in write_ontology(ontology).items()}
    assert read_ontology(files)[0].entities == ontology.entities
