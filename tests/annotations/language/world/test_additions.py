"""What is pasted is read line by line, compared with what is there, and checked."""

from __future__ import annotations

from annotations.language.world import Entity, Ontology, additions_to, read_entities
from tests.annotations.language.sample_ontology import HOME


def test_a_line_is_a_name_and_its_aliases():
    lines = "coke | coca cola,  soda , coke zero,soda\n\n  green   tea\n"
    first, second = read_entities(lines, "object", {"category": "drinks"})
    assert (first.text, first.aliases) == ("coke", ("coca cola", "soda", "coke zero"))
    assert (second.text, second.aliases, second.position.line) == ("green tea", (), 3)
    assert second.attributes == {"category": "drinks"}


def test_what_is_there_and_what_comes_twice_is_left_out():
    additions = additions_to(HOME, read_entities("Tea\nmug\nmug", "object", {}))
    assert [each.text for each in additions.new] == ["mug"]
    assert [each.position.line for each in additions.duplicates] == [1, 3]


def test_a_place_may_be_in_another_room_but_not_twice_in_one():
    again = [Entity("location", "shelf", (), {"room": room}) for room in ("attic", "cellar")]
    additions = additions_to(HOME, again)
    assert additions.new == (again[1],)


def test_only_problems_of_what_is_new_are_told():
    odd = Ontology((*HOME.entities, Entity("object", "lamp", (), {"difficulty": "very"})))
    additions = additions_to(odd, read_entities("cup | knife", "object", {"difficulty": "hard"}))
    assert [each.message for each in additions.problems] == [
        "knife is called knife too",
        "the difficulty of cup is hard",
    ]
    assert not additions.has_errors
    assert additions_to(odd, read_entities("a" * 600, "object", {})).has_errors
