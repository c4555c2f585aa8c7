"""The chart recogniser accepts exactly what a grammar can say, and fast."""

from hypothesis import given
from hypothesis import strategies as st

from annotations.language.grammar import Grammar, Recognizer, read_productions
from tests.annotations.language.grammar.test_grammar import huge_grammar
from tests.annotations.language.random_grammars import TOKENS, small_grammars


@given(small_grammars(), st.lists(st.lists(st.sampled_from(TOKENS), max_size=5), max_size=20))
def test_it_accepts_exactly_the_stream_of_the_grammar(grammar, others):
    commands = set(grammar.commands())
    recognizer = Recognizer(grammar)
    assert all(map(recognizer.accepts, commands))
    for words in [*others, *(command.split()[:-1] for command in commands)]:
        assert recognizer.accepts(" ".join(words)) == (" ".join(words) in commands)


def test_a_grammar_of_a_trillion_recognises_at_once():
    recognizer = Recognizer(huge_grammar())
    assert recognizer.accepts("go " + " ".join(f"w{n % 10}" for n in range(12)))
    assert not recognizer.accepts("go " + " ".join(["w1"] * 11))
    assert not recognizer.accepts("")


def test_ambiguity_that_doubles_with_each_word_costs_no_time():
    lines = ["$Main = " + "$some " * 30, "$some = a | a a | {void}"]
    grammar = Grammar(read_productions("\n".join(lines)).productions)
    assert Recognizer(grammar).accepts(" ".join("a" * 60))
    assert not Recognizer(grammar).accepts(" ".join("a" * 61))
