from dataclasses import replace
from random import Random

from annotations.language.forms import read_form
from annotations.language.world import Entity, Ontology, infer_signatures
from parser_service.neural.ranker.ranked_forms import glosses
from parser_service.neural.ranker.slots import SlotFiller
from tests.parser_service.parsers.new_forms.conftest import NAMED, OBJECT, ROOM, bring, find

KITCHEN = Ontology(
    (
        Entity("object", "apple", (), {"category": "fruits"}),
        Entity("category", "fruits", (), {"singular": "fruit"}),
        Entity("room", "kitchen"),
    )
)


def test_in_the_domain_forms_read_as_the_declared_glosses_say():
    declared = infer_signatures([read_form(find(NAMED))])
    declared["find"] = replace(declared["find"], gloss="look for {1}")
    [gloss] = glosses([find(NAMED)], declared)
    assert gloss == "look for the one with the given name"


def test_strictly_a_predicate_is_called_by_its_name_alone():
    [gloss] = glosses([bring(OBJECT, ROOM)], None)
    assert gloss == "bring the object that is a the object and at the room"


def test_a_text_that_is_no_form_is_its_own_gloss():
    assert glosses(["( bring", "UNKNOWN"], None)[0] == "( bring"


def test_slots_are_filled_with_entities_of_their_class():
    filler = SlotFiller(KITCHEN)
    said = {filler.fill("bring the <object> from the <room>", Random(seed)) for seed in range(99)}
    assert said == {"bring the apple from the kitchen", "bring the fruit from the kitchen"}


def test_a_category_is_said_in_either_number_or_left_open():
    said = {SlotFiller(KITCHEN).fill("a <category>", Random(seed)) for seed in range(20)}
    assert said == {"a fruit", "a fruits", "a objects"}


def test_a_question_is_the_word_and_a_class_without_entities_stays():
    said = SlotFiller(KITCHEN).fill("answer <name> a <question>", Random(0))
    assert said == "answer <name> a question"


def test_equal_seeds_fill_alike():
    text = "the <object> and the <category> and the <object>"
    assert SlotFiller(KITCHEN).fill(text, Random(3)) == SlotFiller(KITCHEN).fill(text, Random(3))
