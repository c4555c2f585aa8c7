from annotations.language.forms import read_form
from annotations.language.grammar import Grammar, read_production
from annotations.language.templates import TaskCategory, read_template
from annotations.language.world import Ontology, infer_signatures
from parser_service.benchmarking.corpus import read_corpus
from parser_service.parsers.generation import generate_candidates
from parser_service.parsers.interface import Knowledge, Pair
from parser_service.parsers.pool import CandidateForm, Pool, WayToForm
from tests.parser_service.parsers.new_forms.conftest import OBJECT, PLACE, ROOM, bring, find

LEFT, RIGHT = (
    f'( bring ( lambda $1 e ( lambda $2 e ( is_a $2 " <object> " ) ( {name} $1 $2 ) ) ) )'
    for name in ("left_of", "right_of")
)


def new_forms(pairs, knowledge=None, is_open=True):
    return {each.form for each in generate_candidates(pairs, knowledge or Knowledge(), is_open).new}


def test_forms_of_the_pairs_come_first_and_are_not_new(pairs):
    generated = generate_candidates(pairs, Knowledge())
    assert set(generated.training) == {pair.form for pair in pairs}
    assert not set(generated.training) & {each.form for each in generated.new}


def test_a_form_that_only_one_kind_of_change_reaches_is_left_out(pairs):
    generated = generate_candidates(pairs, Knowledge())
    assert find(OBJECT, PLACE) in {each.form for each in generated.new}
    assert find(ROOM) not in {each.form for each in generated.new}
    assert generated.counts["drop"] > 0
    assert all(each.support >= 2 for each in generated.new)


def test_each_candidate_says_what_made_it_and_from_what(pairs):
    [candidate] = [
        each
        for each in generate_candidates(pairs, Knowledge()).new
        if each.form == find(OBJECT, PLACE)
    ]
    assert {"geca", "exchange", "retype"} <= set(candidate.steps)
    assert candidate.commands == ("please find the <object> at the <location>",)
    assert {way.origin for way in candidate.ways} <= {pair.form for pair in pairs}


def test_a_closed_set_has_nothing_new(pairs):
    assert new_forms(pairs, is_open=False) == set()


def test_a_declared_predicate_that_no_pair_has_appears_in_the_domain_alone():
    pairs = [Pair("bring what is left of the <object>", LEFT)]
    declared = infer_signatures(map(read_form, (LEFT, RIGHT)))
    assert RIGHT not in new_forms(pairs)
    assert RIGHT in new_forms(pairs, Knowledge(declared, Ontology()))


def test_a_grammar_brings_all_its_forms_and_commands_and_nothing_made(pairs):
    category = TaskCategory(
        "1",
        Grammar((read_production("$Main = seek the {object} | fetch the {object}"),)),
        (read_template("(seek | fetch) the {object} = (find (λ$1:e (is_a $1 {object})))"),),
    )
    generated = generate_candidates(pairs, Knowledge({}, Ontology(), (category,)))
    assert [each.form for each in generated.new] == [find(OBJECT)]
    assert generated.commands == {find(OBJECT): ("seek the <object>", "fetch the <object>")}


def test_support_counts_kinds_of_steps_and_not_their_number():
    ways = (
        WayToForm("f", "drop", "a"),
        WayToForm("f", "drop", "b"),
        WayToForm("f", "geca", "a", weight=2),
    )
    assert CandidateForm("f", ways).support == 3


def test_the_best_supported_come_first_and_steps_are_counted():
    pool = Pool()
    pool.add([WayToForm("a", "drop"), WayToForm("b", "drop"), WayToForm("b", "add")])
    assert [each.form for each in pool.candidates()] == ["b", "a"]
    assert pool.counts() == {"drop": 2, "add": 1}


def test_the_order_of_the_pairs_changes_nothing(pairs):
    assert (
        generate_candidates(pairs, Knowledge()).new
        == generate_candidates(pairs[::-1], Knowledge()).new
    )


def test_bring_is_not_made_of_what_was_never_brought(pairs):
    named = Pair("find <name>", find('name $1 " <name> "'))
    assert bring('name $1 " <name> "') not in new_forms([*pairs, named])


def test_most_unseen_forms_of_the_published_corpus_are_among_the_candidates(shared_data):
    corpus = read_corpus(shared_data / "walker2019", "logical_form")
    sources = ("generated", "paraphrased")
    generated = generate_candidates(corpus.pairs("train", sources), Knowledge())
    made = {each.form for each in generated.new}
    unseen = corpus.pairs("validation", ("paraphrased",))
    assert sum(pair.form in made for pair in unseen) / len(unseen) > 0.8
    assert len(made) < 300
