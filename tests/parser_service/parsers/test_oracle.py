from random import Random

import pytest

from annotations.language.grammar import Grammar, read_productions
from annotations.language.grounding import ground
from annotations.language.templates import (
    TaskCategory,
    TemplateExpander,
    generate,
    read_generator_folder,
    read_template,
)
from annotations.language.texts.errors import Refusal
from annotations.language.world import Entity, Ontology
from parser_service.parsers.interface import Cancelled, Knowledge
from parser_service.parsers.oracle import GRAMMAR, GrammarOracle
from tests.annotations import starter
from tests.parser_service.parsers.pair_files import read_pairs

RULES = """
$Main = $go | $vbfind $thing
$go = ( go | walk ) to the {room}, please
$vbfind = find | look for
$thing = the {kobject} | the {name}
"""


def category(name, *templates):
    grammar = Grammar(read_productions(RULES).productions)
    return TaskCategory(name, grammar, tuple(read_template(line) for line in templates))


@pytest.fixture
def oracle():
    one = category(
        "1",
        "( go | walk ) to the {room} , please = (go {room})",
        "$vbfind the {kobject} = (find {kobject})",
        "look for the {kobject} = (seek {kobject})",
    )
    two = category("2", "$vbfind $thing = (locate $thing)")
    things = Ontology((Entity("object", "tin of soup"), Entity("room", "pantry")))
    return GrammarOracle(knowledge=Knowledge(ontology=things, grammar=(one, two)))


def forms(parser, utterance, beam_width=1):
    return [candidate.form for candidate in parser.predict([utterance], beam_width)[0]]


def test_a_command_gets_the_form_of_its_template(oracle):
    assert forms(oracle, "find the <object>") == ['( find " <object> " )']


def test_a_command_with_entities_is_read_with_their_classes(oracle, tmp_path):
    oracle.save(tmp_path)
    for parser in (oracle, GrammarOracle.load(tmp_path)):
        assert forms(parser, "find the tin of soup") == ['( find " <object> " )']
        assert forms(parser, "walk to the Pantry, please") == ['( go " <room> " )']


def test_numbers_of_the_grammar_are_none_of_the_entities_heard():
    grammar = Grammar(read_productions("$Main = find the $thing\n$thing = {object 1}").productions)
    found = TaskCategory("1", grammar, (read_template("find the $thing = (find $thing)"),))
    soup = Ontology((Entity("object", "tin of soup"),))
    parser = GrammarOracle(knowledge=Knowledge(ontology=soup, grammar=(found,)))
    for utterance, values in (
        ("find the <object>", ()),
        ("find the tin of soup", ("tin of soup",)),
    ):
        (candidate,) = parser.predict([utterance])[0]
        assert (candidate.form, candidate.values) == ('( find " <object> " )', values)


def test_a_comma_may_stand_at_its_word(oracle):
    for command in ("walk to the <room>, please", "go to the <room> , please"):
        assert forms(oracle, command) == ['( go " <room> " )']


@pytest.mark.parametrize("utterance", ["", "find", "find the cup", "find the <object> please not"])
def test_outside_the_grammar_there_is_no_answer(oracle, utterance):
    assert forms(oracle, utterance, beam_width=5) == []


@pytest.mark.parametrize(
    "utterance",
    [
        "Find the tin of soup.",
        "please find the Tin-of-Soup",
        "Hey robot, could you please find the tin of soups? Thanks!",
        "find the tín of soup please",
    ],
)
def test_words_are_read_as_people_write_them(oracle, utterance):
    (best, *_) = oracle.predict([utterance], 5)[0]
    assert (best.form, best.values) == ('( find " <object> " )', ("tin of soup",))


def test_what_is_read_as_it_is_written_scores_better(oracle):
    scores = [
        oracle.predict([each])[0][0].score
        for each in (
            "find the tin of soup",
            "find the tin of soup.",
            "please find the tin of soup.",
        )
    ]
    assert scores == sorted(scores, reverse=True) and scores[0] == 0


def test_overlapping_names_are_read_as_the_grammar_has_them():
    grammar = Grammar(
        read_productions(
            "$Main = find the {kobject} | find the person in the {gesture} {kobject} at the {beacon 1} or {beacon 2}"
        ).productions
    )
    templates = map(
        read_template,
        (
            "find the {kobject} = (find {kobject})",
            "find the person in the {gesture} {kobject} at the {beacon 1} or {beacon 2}"
            " = (find {beacon 2} {beacon 1} {kobject} {gesture})",
        ),
    )
    things = Ontology(
        (
            Entity("object", "orange"),
            Entity("object", "orange coat"),
            Entity("object", "coat"),
            Entity("gesture", "orange"),
            Entity("location", "bed"),
            Entity("location", "bed side table"),
        )
    )
    oracle = GrammarOracle(
        knowledge=Knowledge(
            ontology=things, grammar=(TaskCategory("1", grammar, tuple(templates)),)
        )
    )
    values = [
        oracle.predict([each])[0][0].values
        for each in (
            "Find the orange",
            "find the orange coat",
            "Find the person in the orange coat at the bed side table or bed",
        )
    ]
    assert values == [("orange",), ("orange coat",), ("bed", "bed side table", "coat", "orange")]


def test_of_several_derivations_generation_and_the_oracle_keep_the_same(oracle):
    candidates = forms(oracle, "look for the <object>", beam_width=9)
    assert candidates[:2] == ['( seek " <object> " )', '( find " <object> " )']
    assert len(candidates) == len(set(candidates))


def test_every_generated_command_is_parsed_to_its_own_form(oracle):
    for expansion in generate(oracle.knowledge.grammar).expansions:
        assert forms(oracle, expansion.command) == [expansion.form_text]


def test_saved_it_parses_without_the_world(oracle, tmp_path):
    oracle.save(tmp_path)
    loaded = GrammarOracle.load(tmp_path)
    for expansion in generate(oracle.knowledge.grammar).expansions:
        assert forms(loaded, expansion.command, 9) == forms(oracle, expansion.command, 9)


def test_an_altered_grammar_is_refused(oracle, tmp_path):
    oracle.save(tmp_path)
    (tmp_path / GRAMMAR).write_text((tmp_path / GRAMMAR).read_text().replace("seek", "find"))
    with pytest.raises(Refusal, match=GRAMMAR) as refused:
        GrammarOracle.load(tmp_path)
    assert refused.value.code == "saved_file_altered"


@pytest.mark.parametrize("knowledge", [Knowledge(), Knowledge(grammar=(category("1"),))])
def test_without_templates_it_refuses(knowledge):
    with pytest.raises(Refusal) as refused:
        GrammarOracle(knowledge=knowledge).fit()
    assert refused.value.code == "no_templates"


def test_with_templates_there_is_nothing_to_learn(oracle):
    oracle.fit()
    assert oracle.parameters() == 0


def test_a_cancelled_prediction_stops(oracle):
    def cancel():
        raise Cancelled

    with pytest.raises(Cancelled):
        oracle.predict(["find the <object>"], check=cancel)


@pytest.mark.parametrize("split", ["gen", "gen_logical"])
@pytest.mark.parametrize("part", ["train", "val"])
def test_it_is_right_on_every_published_generated_pair(shared_data, tmp_path, split, part):
    grammar = read_generator_folder(shared_data / "generator-2018").categories()
    oracle = GrammarOracle(knowledge=Knowledge(grammar=grammar))
    oracle.save(tmp_path)
    pairs = read_pairs(shared_data / "walker2019" / split / f"{part}.txt")
    answers = GrammarOracle.load(tmp_path).predict([pair.utterance for pair in pairs])
    assert [[pair.form] for pair in pairs] == [[c.form for c in answer] for answer in answers]


def test_paraphrases_are_mostly_outside_the_grammar(shared_data):
    grammar = read_generator_folder(shared_data / "generator-2018").categories()
    pairs = read_pairs(shared_data / "walker2019" / "para" / "val.txt")
    answers = GrammarOracle(knowledge=Knowledge(grammar=grammar)).predict(
        [pair.utterance for pair in pairs]
    )
    assert sum(map(bool, answers)) < 0.05 * len(pairs)


def test_its_forms_are_from_the_grammar(oracle):
    assert [each.origin for each in oracle.predict(["find the <object>"])[0]] == ["grammar"]


def oracle_of(*entities, rules="$Main = bring the {kobject} | in the {room} , find the {kobject}"):
    templates = (
        "bring the {kobject} = (bring {kobject})",
        "in the {room} , find the {kobject} = (find {kobject} {room})",
    )
    grammar = Grammar(read_productions(rules).productions)
    one = TaskCategory("1", grammar, tuple(map(read_template, templates)))
    return GrammarOracle(knowledge=Knowledge(ontology=Ontology(entities), grammar=(one,)))


ODD = (
    "M&M's",
    "Dr. Pepper",
    "salt & pepper",
    "7-up",
    "C++",
    "C#",
    "C",
    "trashbin",
    "Jose",
    "José",
    "½ apple",
    "shelf -1",
    "shelf 1",
    "हिन्दी",
    "side table",
    "Strauß",
)


@pytest.mark.parametrize("name", ODD)
@pytest.mark.parametrize("said", ["bring the {}", "Please bring the {}.", "Bring the {} please!"])
def test_odd_names_are_heard_as_they_are_written(name, said):
    oracle = oracle_of(*(Entity("object", each) for each in ODD))
    best, *_ = oracle.predict([said.format(name)], 5)[0]
    assert best.values == (name,)


@pytest.mark.parametrize(
    ("said", "name"),
    [
        ("trash bin", "trashbin"),
        ("7up", "7-up"),
        ("Sidetable", "side table"),
        ("dr pepper", "Dr. Pepper"),
        ("m&ms", "M&M's"),
        ("salt and", None),
        ("JOSE", "Jose"),
        ("Strauss", "Strauß"),
    ],
)
def test_names_are_heard_without_their_signs_and_spaces(said, name):
    oracle = oracle_of(*(Entity("object", each) for each in ODD))
    answers = oracle.predict([f"Bring the {said}."], 5)[0]
    assert [each.values for each in answers[:1]] == ([(name,)] if name else [])


def test_a_name_that_may_be_two_is_answered_twice():
    oracle = oracle_of(Entity("object", "Zoë"), Entity("object", "Zoé"))
    answers = oracle.predict(["please bring the Zoe"], 5)[0]
    assert {each.values for each in answers} == {("Zoë",), ("Zoé",)}


def test_a_name_beats_an_alias_of_the_same_spelling():
    oracle = oracle_of(Entity("object", "tin", ("can",)), Entity("object", "can"))
    answers = oracle.predict(["please bring the can"], 5)[0]
    assert [each.values for each in answers] == [("can",)]


def test_a_comma_of_the_grammar_need_not_be_said():
    oracle = oracle_of(Entity("object", "tea"), Entity("room", "kitchen"))
    for said in ("in the kitchen find the tea", "In the kitchen, find the tea."):
        assert oracle.predict([said], 5)[0][0].values == ("tea", "kitchen")


def test_two_hundred_commands_are_understood_with_a_capital_and_a_full_stop():
    categories, ontology, random = starter.categories(), starter.ontology(), Random(7)
    oracle = GrammarOracle(knowledge=Knowledge(ontology=ontology, grammar=categories))
    derivations = [
        derivation
        for category in categories
        for template in category.templates
        for derivation in TemplateExpander(category.grammar).derivations(template)
    ]
    texts = [
        ground(each.symbols, each.form, ontology, random).text
        for each in random.sample(derivations, 200)
    ]
    plain = oracle.predict(texts)
    written = oracle.predict([f"{text[0].upper()}{text[1:]}." for text in texts])
    assert all(plain)
    assert [each[0].form for each in written] == [each[0].form for each in plain]
    assert [each[0].values for each in written] == [each[0].values for each in plain]
