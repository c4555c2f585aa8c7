from __future__ import annotations

from random import Random

from hypothesis import given
from hypothesis import strategies as st

from annotations.language.forms import canonical_text, read_form, to_template
from annotations.language.grounding import Anonymizer, deanonymize, ground
from annotations.language.grounding.deanonymizer import Deanonymized
from annotations.language.symbols import Text, read_wildcard
from annotations.language.templates import TemplateExpander, read_generator_folder
from annotations.language.templates.filling import fill_anonymized
from tests.annotations.language.ontology_files import read_ontology_folder
from tests.annotations.language.published import SHARED, needs_corpus
from tests.annotations.language.sample_ontology import HOME


def put_back(text: str, form: str, numbered: bool = False) -> Deanonymized:
    return deanonymize(read_form(form), Anonymizer(HOME, numbered).anonymize(text), HOME)


def test_entities_return_to_their_slots() -> None:
    result = put_back(
        "bring the Cuppa from the shelf",
        '(bring (λ$1:e (is_a $1 "<object>") (at $1 "<location>")))',
    )
    assert to_template(result.form) == '(bring (λ$1:e (is_a $1 "tea") (at $1 "shelf")))'
    assert result.open_slots == ()
    assert [(slot.entity_class, slot.value) for slot in result.slots] == [
        ("object", "tea"),
        ("location", "shelf"),
    ]


def test_two_values_of_one_class_are_ambiguous_without_numbers() -> None:
    result = put_back("take it from the shelf to the stool", '(put (at "<location>") "<location>")')
    assert to_template(result.form) == '(put (at "<location>") "<location>")'
    assert [slot.candidates for slot in result.open_slots] == [("shelf", "stool")] * 2
    assert all(slot.is_ambiguous for slot in result.slots)


def test_numbers_make_two_values_of_one_class_certain() -> None:
    form = '(put (at "<location1>") "location0")'
    result = put_back("to the stool from the shelf", form, numbered=True)
    assert to_template(result.form) == '(put (at "shelf") "stool")'
    unnumbered = put_back("to the stool from the shelf", form)
    assert unnumbered.form == result.form


def test_one_mention_does_not_fill_two_slots() -> None:
    result = put_back("take it to the stool", '(put (at "<location>") "<location>")')
    assert [slot.value for slot in result.slots] == [None, None]
    twice = put_back("from the stool to the stool", '(put (at "<location>") "<location>")')
    assert [slot.value for slot in twice.slots] == ["stool", "stool"]


def test_what_nobody_named_is_open_and_offers_the_ontology() -> None:
    result = put_back("follow somebody", '(follow "<name>" UNKNOWN 3 "tea")')
    name, place = result.open_slots
    assert (name.candidates, name.is_ambiguous) == (("Bo", "Ada"), False)
    assert (place.token, place.entity_class, place.candidates) == ("UNKNOWN", "", ())


def test_unknown_as_a_whole_has_no_slot() -> None:
    assert put_back("dance", "UNKNOWN").slots == ()


@given(
    st.permutations(["object", "room", "placement", "name", "gesture", "category"]),
    st.integers(1, 6),
    st.integers(),
)
def test_anonymizing_and_back_restores_unambiguous_commands(
    names: list[str], count: int, seed: int
) -> None:
    wildcards = [read_wildcard("{" + name + "}") for name in names[:count]]
    symbols = tuple(each for wildcard in wildcards for each in (Text("with"), wildcard))
    form = read_form(f"(do {' '.join('{' + name + '}' for name in names[:count])})")
    made = ground(symbols, form, HOME, Random(seed))
    anonymized = Anonymizer(HOME).anonymize(made.text)
    assert anonymized.text == made.anonymized_text
    assert deanonymize(fill_anonymized(form, {}), anonymized, HOME).form == made.form


@needs_corpus
def test_every_certain_form_of_the_2018_generator_is_right() -> None:
    folder = SHARED / "generator-2018"
    ontology, _ = read_ontology_folder(folder)
    anonymizer, random = Anonymizer(ontology), Random(1)
    same_text = certain = commands = 0
    for category in read_generator_folder(folder).categories():
        expander = TemplateExpander(category.grammar)
        for template in category.templates:
            for derivation in expander.derivations(template):
                made = ground(derivation.symbols, derivation.form, ontology, random)
                anonymized = anonymizer.anonymize(made.text)
                form = fill_anonymized(derivation.form, {})
                result = deanonymize(form, anonymized, ontology)
                commands += 1
                same_text += anonymized.command == derivation.anonymized_text
                if not result.open_slots:
                    certain += 1
                    assert canonical_text(result.form) == canonical_text(made.form), made.text
    assert same_text > 0.97 * commands
    assert certain > 0.8 * commands
