"""Many forms, many templates, many pairs: bounded, and stopped when asked."""

from itertools import product
from random import Random

import pytest

from annotations.language.forms import read_form
from annotations.language.grammar import Grammar, read_production
from annotations.language.templates import TaskCategory, read_template
from annotations.language.world import Ontology, infer_signatures
from parser_service.neural.ranker.ranked_forms import collect
from parser_service.parsers import closure, geca, generation
from parser_service.parsers.closure import close, read_forms
from parser_service.parsers.generation import generate_candidates
from parser_service.parsers.interface import REFUSAL, Cancelled, Knowledge, Pair

VERBS = [f"verb{number}" for number in range(12)]
LOOKS = [f"look{number}" for number in range(12)]
PLACES = {"": "", ' ( at $1 " <room> " )': " from the <room>"}


def many_pairs() -> list[Pair]:
    """288 forms: each action with each look, somewhere or anywhere."""
    return [
        Pair(
            f"please {verb} the {look} <object>{said}",
            f'( {verb} ( lambda $1 e ( is_a $1 " <object> " ) ( {look} $1 ){place} ) )',
        )
        for verb, look, (place, said) in product(VERBS, LOOKS, PLACES.items())
    ]


def after(number):
    """A check that cancels after so many calls."""
    calls = iter(range(number))

    def check():
        if next(calls, None) is None:
            raise Cancelled

    return check


def grammar_of(templates: int) -> TaskCategory:
    lines = (f'do{n} it = (do{n} "it")' for n in range(templates))
    return TaskCategory(
        "1", Grammar((read_production("$Main = it"),)), tuple(map(read_template, lines))
    )


def commands_of(ranked, examples):
    """The examples of forms, without those of requests that are no command."""
    return {each.utterance for each in examples if ranked.origin(each.form) != REFUSAL}


def test_nine_hundred_templates_are_nine_hundred_forms_with_their_commands():
    knowledge = Knowledge({}, Ontology(()), (grammar_of(900),))
    ranked, examples, _ = collect([Pair("go", '( go " it " )')], knowledge, True)
    assert len(ranked.forms) - ranked.requests == 901
    assert commands_of(ranked, examples) == {"go", *(f"do{n} it" for n in range(900))}


def test_of_more_forms_than_a_ranker_reads_some_are_left_out_with_their_commands(monkeypatch):
    monkeypatch.setattr(generation, "MOST_GRAMMAR_FORMS", 5)
    knowledge = Knowledge({}, Ontology(()), (grammar_of(9),))
    ranked, examples, _ = collect([Pair("go", '( go " it " )')], knowledge, True)
    assert len(ranked.forms) - ranked.requests == len(commands_of(ranked, examples)) == 6


def test_a_closure_of_many_forms_is_bounded_and_visits_all_of_them_evenly(monkeypatch):
    monkeypatch.setattr(closure, "MOST_WAYS", 1000)
    forms = sorted(pair.form for pair in many_pairs())
    made = close(forms, infer_signatures(map(read_form, forms)))
    origins = sorted({forms.index(each.origin) for each in made})
    assert 1000 <= len(made) < 1100
    assert origins[0] < len(forms) / 4 and origins[-1] > len(forms) * 3 / 4


def test_of_very_many_parts_the_most_frequent_are_put_in(monkeypatch):
    monkeypatch.setattr("parser_service.parsers.contexts.MOST_PARTS", 3)
    looks = ["( find ( lambda $1 e ( look0 $1 ) ) )"] * 2
    looks += [f"( find ( lambda $1 e ( look{n} $1 ) ) )" for n in range(1, 9)]
    read = list(read_forms(looks))
    contexts = closure.find_contexts(read)
    assert [str(leaf.predicate) for leaf in contexts.leaves] == ["look0", "look1", "look2"]


@pytest.mark.parametrize("bound", ["MOST_RULES", "MOST_MADE"])
def test_recombination_of_many_pairs_is_bounded(bound, monkeypatch):
    pairs = Random(0).sample(many_pairs(), 150)
    everything = len(geca.geca(pairs))
    monkeypatch.setattr(geca, bound, 40)
    assert 0 < len(geca.geca(pairs)) < everything / 2


@pytest.mark.parametrize("calls", [0, 50, 400, 700])
def test_whoever_asks_stops_the_making_of_candidates(calls):
    with pytest.raises(Cancelled):
        generate_candidates(many_pairs(), Knowledge(), check=after(calls))
