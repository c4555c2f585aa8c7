from __future__ import annotations

from pathlib import Path
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.language.forms import (
    Choice,
    Symbol,
    Text,
    Wildcard,
    read_form,
    read_wildcard,
    to_template,
)
from annotations.language.grounding import ground
from annotations.language.grounding.grounding import Grounded
from annotations.language.texts.errors import LanguageError
from annotations.language.world import Entity, Ontology
from tests.annotations.language.ontology_files import read_ontology_folder
from tests.annotations.language.published import SHARED, needs_corpus


def thing(text: str, **attributes: str) -> Entity:
    return Entity("object", text, (), attributes)


def place(text: str, room: str, *flags: str) -> Entity:
    return Entity("location", text, (), {"room": room, **dict.fromkeys(flags, "true")})


HOME = Ontology(
    (
        Entity("category", "drinks", (), {"singular": "drink"}),
        thing("tea", category="drinks", canPour="true", weight="2"),
        thing("juice", category="drinks", type="alike", weight="10"),
        Entity("category", "toys"),
        thing("ball", category="toys", type="special"),
        Entity("room", "attic"),
        place("shelf", "attic", "isPlacement"),
        Entity("room", "cellar"),
        place("shelf", "cellar", "isPlacement", "isBeacon"),
        place("stool", "cellar", "isBeacon"),
        Entity("name", "Bo"),
        Entity("name", "Bo", (), {"gender": "Male"}),
        Entity("name", "Ada"),
        Entity("name", "Ulf", (), {"gender": "Male"}),
        Entity("gesture", "waving"),
        Entity("question", "What is up?", (), {"answer": "The sky."}),
        Entity("whattosay", "a joke"),
    )
)


def symbols(text: str) -> tuple[Symbol, ...]:
    """Words and wildcards without spaces inside braces other than those that ``_`` stands for."""
    return tuple(
        read_wildcard(word.replace("_", " ")) if word.startswith("{") else Text(word)
        for word in text.split()
    )


def grounded(
    text: str, form: str = "UNKNOWN", seed: int = 0, ontology: Ontology = HOME
) -> Grounded:
    return ground(symbols(text), read_form(form), ontology, Random(seed))


def texts(text: str, form: str = "UNKNOWN") -> set[str]:
    """What many seeds give."""
    return {grounded(text, form, seed).text for seed in range(60)}


def test_every_type_draws_what_it_allows_and_all_of_it() -> None:
    assert texts("{object}") == {"tea", "juice", "ball"}
    assert texts("{kobject}") == {"tea"} == texts("{object_known}")
    assert texts("{aobject}") == {"juice"}
    assert texts("{sobject}") == {"ball"}
    assert texts("{placement}") == {"shelf"}
    assert texts("{beacon}") == {"shelf", "stool"}
    assert texts("{room}") == {"attic", "cellar"}
    assert texts("{male}") == {"Bo", "Ulf"}
    assert texts("{female}") == {"Bo", "Ada"}
    assert texts("{category}") == {"drinks", "toys"}
    assert texts("{gesture} {whattosay}") == {"waving a joke"}


@pytest.mark.parametrize(
    ("condition", "expected"),
    [
        ('Category="DRINKS"', {"tea", "juice"}),
        ("canPour=true", {"tea"}),
        ("canPour=false", {"juice", "ball"}),
        ("canPour=null", {"juice", "ball"}),
        ('not_category="drinks"', {"ball"}),
        ('canPour=true_or_name="ball"', {"tea", "ball"}),
        ('category="drinks"_xor_canPour=true', {"juice"}),
        ('category="drinks"_canPour!=true', {"juice"}),
        ("weight>=2", {"tea", "juice"}),
        ("weight>2", {"juice"}),
        ("weight=10", {"juice"}),
        ("weight<10", {"tea"}),
    ],
)
def test_a_where_clause_restricts_the_draw(condition: str, expected: set[str]) -> None:
    assert texts("{object_where_" + condition + "}") == expected


def test_a_condition_may_speak_of_another_wildcard() -> None:
    for seed in range(20):
        said = grounded("{beacon_where_room={room_1}} {room_1}", seed=seed).text
        assert said in ("shelf cellar", "stool cellar")


def test_a_condition_on_a_room_finds_the_place_in_it() -> None:
    said = {
        grounded("{room_1} {placement_where_room={room_1}}", seed=seed).values[1][1]
        for seed in range(30)
    }
    assert {entity.attribute("room") for entity in said} == {"attic", "cellar"}


def test_one_name_and_number_is_one_value_everywhere() -> None:
    made = grounded("{object_1} or {object_1}", "(bring {object 1} {object 1})")
    first, _, second = made.text.split()
    assert first == second
    assert to_template(made.form) == f'(bring "{first}" "{first}")'


def test_other_numbers_and_none_are_different_values() -> None:
    for seed in range(20):
        words = grounded("{object_1} {object_2} {object}", seed=seed).text.split()
        assert sorted(words) == ["ball", "juice", "tea"]


def test_a_draw_leaves_to_each_wildcard_what_it_alone_can_take() -> None:
    for seed in range(20):
        assert set(grounded("{object} {sobject} {kobject}", seed=seed).text.split()[1:]) == {
            "ball",
            "tea",
        }


def test_wildcards_of_a_form_without_number_follow_those_of_the_command() -> None:
    for seed in range(10):
        made = grounded("{object} then {object}", "(two {object} {object})", seed)
        first, _, second = made.text.split()
        assert to_template(made.form) == f'(two "{first}" "{second}")'


def test_the_obfuscated_value_says_less() -> None:
    assert texts("{object?}") == {"drink", "toys"}
    assert texts("{category?}") == {"objects"}
    assert texts("{room?}") == {"room"}
    assert texts("{beacon?}") == {"cellar"}
    made = grounded("{kobject?_1} and {kobject_1}", "(f {kobject? 1} {kobject 1})")
    assert made.text == "drink and tea"
    assert to_template(made.form) == '(f "drink" "tea")'


def test_a_question_is_a_word_and_its_text_a_note() -> None:
    made = grounded("answer a {question}", "(answer {question})")
    assert made.text == "answer a question"
    assert to_template(made.form) == '(answer "question")'
    assert made.notes == ("Q: What is up? A: The sky.",)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('{name_where_name="Ada"} {pron} {pron_sub} {pron_posadj} {pron_pab}', "her she her hers"),
        (
            '{name_where_name="Ulf"} {pron_obj} {pron_sub} {pron_pos} {pron_posabs}',
            "him he his his",
        ),
        (
            '{name_where_name="Bo"} {pron} {pron_sub} {pron_paj} {pron_pab}',
            "them they their theirs",
        ),
        ("{gesture} {pron} {pron_paj} {pron_sub} {pron_pab}", "it its it its"),
        ('{female_where_name="Ada"} {gesture} {pron} x x x', "her x x x"),
    ],
)
def test_a_pronoun_refers_to_the_last_name_and_else_to_the_last_thing(
    text: str, expected: str
) -> None:
    assert " ".join(grounded(text).text.split()[-4:]) == expected


def test_a_name_of_either_gender_is_them_as_in_the_published_corpus() -> None:
    made = grounded('meet {name_1_where_name="Bo"} and follow {pron}', "(follow {pron})")
    assert made.text == "meet Bo and follow them"
    assert made.anonymized_text == "meet <name> and follow them"
    assert to_template(made.form) == '(follow "Bo")'


def test_void_says_nothing_and_leaves_its_note() -> None:
    note = (Text("close"), Wildcard("room", id=1), Text(","), Choice(((Text("now"),),)))
    made = ground(
        (Text("go"), Wildcard("void", meta=note), Wildcard("room", id=1)),
        read_form("(go {room 1})"),
        HOME,
        Random(3),
    )
    room = made.text.split()[1]
    assert made.text == f"go {room}"
    assert made.notes == (f"close {room}, now",)
    assert made.values == ((Wildcard("room", id=1), Entity("room", room)),)


def test_equal_seeds_give_equal_results() -> None:
    text = "bring {object} and {object} to {name} at {beacon}"
    assert grounded(text, seed=5) == grounded(text, seed=5)
    assert len(texts(text)) > 10


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("{object_where_fruit=true}", "{object where fruit = true}"),
        ("{object_known_1} {object_special_1}", "{object known 1} and {object special 1}"),
        ("{placement_1} {placement_2}", "{placement"),
        ("{sobject_1} {sobject_2}", "{sobject"),
        ("{room_1_where_name={room_2}} {room_2_where_name={room_1}}", "{room 1"),
    ],
)
def test_what_cannot_be_satisfied_is_said(text: str, named: str) -> None:
    with pytest.raises(LanguageError) as caught:
        grounded(text)
    assert named in caught.value.message
    assert caught.value.hint


WILDCARDS = st.sampled_from(
    [
        "object",
        "kobject",
        "aobject?",
        "sobject",
        "room 1",
        "room 2",
        "beacon 1",
        "placement 2",
        "name",
        "female 1",
        "pron",
        "pron sub",
        "void",
        "gesture",
        "category",
        "question",
        "whattosay",
    ]
)


@given(st.lists(WILDCARDS, max_size=8, unique=True), st.integers())
def test_a_grounding_has_no_wildcard_left_and_no_value_twice(names: list[str], seed: int) -> None:
    command = tuple(read_wildcard("{" + name + "}") for name in names)
    try:
        made = ground(command, read_form("UNKNOWN"), HOME, Random(seed))
    except LanguageError as error:
        assert "too few" in error.message
        return
    said = [(entity.entity_class, entity.text) for _, entity in made.values]
    assert len(said) == len(set(said))
    assert "{" not in made.text and "  " not in made.text


@needs_corpus
def test_the_real_ontology_grounds_the_conditions_of_the_2019_grammar() -> None:
    ontology, _ = read_ontology_folder(Path(SHARED / "generator-2019"))
    for condition in ("canPourIn=true", "fruit=true", 'Category="food"_canPour=true'):
        assert grounded("{object_where_" + condition + "}", ontology=ontology).text
    assert grounded("{object_special_where_canPlaceIn=true}", ontology=ontology).text in (
        "box",
        "bag",
    )
