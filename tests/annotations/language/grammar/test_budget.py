"""Expanding stops after a number of steps, whether its results are kept or thrown away."""

from itertools import islice, pairwise

import pytest

from annotations.language.forms import Nonterminal, SymbolReader
from annotations.language.grammar import (
    MAX_WORDS,
    Budget,
    Grammar,
    Recognizer,
    TooManyCombinations,
    read_productions,
)
from annotations.language.texts.errors import LanguageError, Position
from tests.work import steps_of


def grammar_of(*lines):
    return Grammar(read_productions("\n".join(lines), "rules.txt").productions)


def sequence(text):
    return SymbolReader(text, Position()).whole_line()


DIGITS = "$digit = " + " | ".join(f"w{n}" for n in range(10))
HUGE = grammar_of("$Main = go " + "$digit " * 12, DIGITS)


def test_a_budget_counts_what_is_spent_and_refuses_more():
    budget = Budget(10)
    budget.spend(10)
    with pytest.raises(TooManyCombinations, match=r"\b10\b"):
        budget.spend()
    assert budget.spent == 11


def test_a_budget_without_a_number_has_no_limit():
    budget = Budget()
    budget.spend(10**12)
    assert budget.spent == 10**12


def test_an_expansion_that_fits_its_budget_is_the_whole_one():
    budget = Budget(1_000)
    commands = list(HUGE.expander.stream(sequence("$digit $digit"), budget))
    assert len(commands) == 100
    assert 100 < budget.spent <= 1_000


def test_an_expansion_beyond_its_budget_stops():
    with pytest.raises(TooManyCombinations):
        list(HUGE.commands(budget=Budget(10_000)))


def test_the_first_results_of_a_huge_grammar_cost_little():
    budget = Budget(100_000)
    assert len(list(islice(HUGE.commands(budget=budget), 100))) == 100


def test_recognising_spends_steps_too():
    with pytest.raises(TooManyCombinations):
        Recognizer(HUGE).accepts("go " + "w1 " * 12, Budget(5))
    assert Recognizer(HUGE).accepts("go " + "w1 " * 12, Budget(1_000))


@pytest.mark.parametrize("last", ["x | y", "{void} | {void meta: nothing}", "$b | $c"])
def test_a_grammar_whose_commands_are_too_long_is_refused_at_once(last):
    names = [f"$a{n}" for n in range(1, 61)]
    chain = [f"{one} = {other} {other}" for one, other in pairwise(names)]
    silent = ["$b = {void}", "$c = {void}"]
    grammar = grammar_of("$Main = $a1 $a1", *chain, f"{names[-1]} = {last}", *silent)
    assert steps_of(grammar.problems) < 15_000  # expanding the first rule alone takes 2^60
    (problem,) = [each for each in grammar.problems() if each.is_error]
    assert str(problem.position) == "rules.txt:52:1"
    assert "$a51 " in problem.message and " 512 " in problem.message
    with pytest.raises(LanguageError, match=r"\$a51 .*\b512\b"):
        grammar.size()


def test_commands_of_the_greatest_length_are_fine():
    assert not grammar_of("$Main = " + "word " * MAX_WORDS).problems()
    grammar = grammar_of("$Main = " + "word " * (MAX_WORDS + 1))
    assert [problem.is_error for problem in grammar.problems()] == [True]
    assert (
        grammar_of("$Main = (a | b c) $x", "$x = {void} | d").longest((Nonterminal("Main"),)) == 3
    )


def test_repeated_lines_are_looked_for_within_a_budget():
    lines = [f"$Main = (a{n} | b{n}) " + "(x | y) " * 8 + "long " * 400 for n in range(50)]
    grammar = grammar_of(*lines)
    assert steps_of(grammar.problems) < 5_000_000
    (problem,) = grammar.problems()
    assert problem.message and not problem.is_error
