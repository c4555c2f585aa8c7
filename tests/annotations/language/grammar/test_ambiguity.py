"""Lines of one nonterminal that repeat one another are reported at the later line."""

from __future__ import annotations

from annotations.language.grammar import Grammar, read_productions


def problems_of(*lines: str) -> list[str]:
    grammar = Grammar(read_productions("\n".join(lines), "rules.txt").productions)
    return [str(problem) for problem in grammar.problems() if "ambiguous" in problem.message]


def test_a_line_that_repeats_part_of_an_earlier_one_names_it_and_an_example():
    (problem,) = problems_of("$Main = go (up | down)", "$Main = go $way", "$way = down | left")
    assert problem.startswith(
        "rules.txt:2:1: warning: ambiguous: 1 of 2 expansions repeats rules.txt:1:1"
    )
    assert '"go down"' in problem


def test_lines_without_a_common_expansion_are_fine():
    assert problems_of("$Main = go up", "$Main = go $way", "$way = down | left") == []


def test_the_same_line_twice_collapses_and_is_no_ambiguity():
    assert problems_of("$Main = go up", "$Main = go up") == []


def test_two_nonterminals_may_say_the_same():
    assert problems_of("$Main = $a now | $b", "$a = go", "$b = go") == []


def test_wildcards_are_told_apart_by_their_id():
    assert problems_of("$Main = find {name 1}", "$Main = find {name 2}") == []


def test_a_note_for_the_referee_makes_no_difference_to_what_is_said():
    (problem,) = problems_of("$Main = {void}", "$Main = {void meta: stay}")
    assert "such as saying nothing" in problem


def test_a_cycle_is_reported_alone():
    assert problems_of("$Main = $a | go", "$Main = go", "$a = $Main") == []


def test_lines_too_large_to_compare_are_passed_over():
    words = " | ".join(f"w{number}" for number in range(10))
    assert (
        problems_of(f"$Main = {'$word ' * 12}", f"$Main = {'$word ' * 11} w1", f"$word = {words}")
        == []
    )
