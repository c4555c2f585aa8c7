"""Grammars: reading productions, finding problems, counting and streaming commands."""

from itertools import islice

import pytest
from hypothesis import given

from annotations.language.forms import Choice, Nonterminal, Text
from annotations.language.grammar import (
    Grammar,
    Production,
    print_production,
    read_production,
    read_productions,
)
from annotations.language.texts.errors import LanguageError, Position
from tests.annotations.language.random_grammars import (
    EXPANSIONS,
    NAMES,
    naive,
    small_grammars,
)


def grammar_of(*lines):
    file = read_productions("\n".join(lines), "rules.txt")
    assert not file.problems
    return Grammar(file.productions)


def huge_grammar():
    """10¹² commands: twelve places with ten words each."""
    digits = "$digit = " + " | ".join(f"w{n}" for n in range(10))
    return grammar_of("$Main = go " + "$digit " * 12, digits)


def messages(problems):
    return [str(problem) for problem in problems]


def only_problem(text):
    (problem,) = read_productions(text, "rules.txt").problems
    return problem


@given(NAMES, EXPANSIONS)
def test_a_printed_production_reads_back_as_the_same_value(name, expansion):
    production = Production(name, expansion)
    line = print_production(production)
    assert read_production(line) == production
    assert read_productions(f"{line}\n{line}\n").productions == (production, production)


def test_a_byte_order_mark_comments_of_all_signs_and_blank_lines_are_skipped():
    text = "\ufeff; one\n# two\n% three\n// four\n/* five\n$no = x */\n\n$Main = a % b\n"
    file = read_productions(text, "rules.txt")
    assert [print_production(each) for each in file.productions] == ["$Main = a"]
    assert file.productions[0].position == Position("rules.txt", 8, 1)


def test_directives_are_read_inside_comments_only_and_prose_is_none():
    file = read_productions(
        "; grammar name Category I\n; grammar tier Easy\n; import common.txt\n"
        '# load "my rules.txt"\n; import tasks.txt as $task\n# ; import not_this.txt\n'
        "# standalone. Import using: common.txt\n$Main = a"
    )
    assert (file.name, file.tier) == ("Category I", "Easy")
    imports = [(each.path, each.alias) for each in file.imports]
    assert imports == [("common.txt", ""), ("my rules.txt", ""), ("tasks.txt", "task")]
    assert [each.position.line for each in file.imports] == [3, 4, 5]


def test_a_backslash_takes_the_meaning_from_the_next_character():
    production = read_production(r"$Main = \$5 \(a\|b\) c\; \\")
    assert [symbol.value for symbol in production.expansion] == ["$5", "(a|b)", "c;", "\\"]


def test_commas_are_words_of_their_own_and_apostrophes_stay_in_theirs():
    (command,) = grammar_of("$Main = go, take {room}'s what's").commands()
    assert command == "go , take <room> 's what's"


def test_choices_nest_and_a_parenthesis_around_one_alternative_is_none():
    expansion = read_production("$a = (((x)) | (y | z)) w").expansion
    choice = Choice(((Text("x"),), (Text("y"),), (Text("z"),)))
    assert expansion == (choice, Text("w"))


def test_a_repeated_head_adds_alternatives_and_equal_ones_collapse():
    grammar = grammar_of("$Main = a | b", "$Main = b", "$Main = (a | c)")
    assert list(grammar.commands()) == ["a", "b", "c"]
    assert grammar.size() == 3
    assert len(grammar.productions) == 3


def test_references_know_where_they_stand():
    production = read_production("$a = x $b (y | $c)", Position("rules.txt", 7))
    assert [(name, place.column) for name, place in production.references] == [("b", 8), ("c", 16)]
    assert production.expansion[1] == Nonterminal("b")


@pytest.mark.parametrize(
    ("text", "line", "column", "named"),
    [
        ("$Main = a\n$b = (x | y", 2, 6, ""),
        ("$Main = a\n$b = x) | y", 2, 7, ""),
        ("$Main = a | ", 1, 13, ""),
        ("$Main = (a | | b)", 1, 14, ""),
        ("$Main = a\nhello there", 2, 1, ""),
        ("$Main = {spaceship}", 1, 10, "{spaceship}"),
        ("$Main = {room", 1, 9, ""),
        ("$Main = room}", 1, 13, ""),
        ("$Main = costs $5", 1, 15, ""),
        ("$Main = a\n/* no end", 2, 1, ""),
        ("$Main = a\\", 1, 10, ""),
    ],
)
def test_a_malformed_line_is_an_error_with_its_place(text, line, column, named):
    problem = only_problem(text)
    assert problem.is_error
    assert problem.message and named in problem.message
    assert problem.position == Position("rules.txt", line, column)


def test_a_file_that_is_no_grammar_gives_one_error_and_not_one_a_line():
    problem = only_problem("<?xml version='1.0'?>\n<rooms>\n" + "<room/>\n" * 500)
    assert problem.position == Position("rules.txt", 1, 1) and problem.hint


def test_five_thousand_parentheses_are_refused_at_once():
    problem = only_problem("$Main = " + "(" * 5000 + "a" + ")" * 5000)
    assert " 64" in problem.message
    assert problem.position.column == 8 + 65


def test_sixty_four_nested_choices_are_read_and_expanded():
    text = "$Main = " + "(x | y " * 64 + "z" + ")" * 64
    grammar = grammar_of(text)
    assert grammar.size() == 65
    assert len(list(grammar.commands())) == 65


def test_an_undefined_nonterminal_is_a_warning_where_it_is_used_and_yields_nothing():
    grammar = grammar_of("$Main = a $lost | b | $gone", "$gone = $lost")
    assert messages(grammar.problems()) == [
        "rules.txt:1:11: warning: nothing defines $lost, used 2 times "
        "(lines that use it make no commands; define it or remove it)"
    ]
    assert list(grammar.commands()) == ["b"]
    assert grammar.size() == 1


def test_an_unreachable_nonterminal_is_a_warning_and_one_in_a_note_is_reached():
    grammar = grammar_of("$Main = a {void meta: say $note}", "$note = x", "$alone = y")
    assert messages(grammar.problems()) == [
        "rules.txt:3:1: warning: $Main never reaches $alone (use it or remove it)"
    ]


def test_a_cycle_is_an_error_that_names_it():
    grammar = grammar_of("$Main = $a", "$a = x | y $b", "$b = ($a | z)")
    (problem,) = grammar.problems()
    assert problem.is_error
    assert "$a → $b → $a" in problem.message
    assert problem.position == Position("rules.txt", 3, 7)
    for refused in (grammar.size, grammar.commands, lambda: grammar.expander):
        with pytest.raises(LanguageError, match=r"\$a → \$b → \$a"):
            refused()


def test_a_cycle_out_of_reach_and_one_of_five_thousand_are_found_too():
    long = [f"$a{n} = $a{(n + 1) % 5000}" for n in range(5000)]
    problems = grammar_of("$Main = x", "$me = $me", *long).problems()
    cycles = [problem.message for problem in problems if problem.is_error]
    assert cycles[0] == "a cycle: $me → $me"
    assert len(cycles) == 2
    assert len(cycles[1]) < 200


def test_a_chain_of_a_thousand_nonterminals_is_refused_with_its_depth():
    grammar = grammar_of("$Main = $a0", *(f"$a{n} = $a{n + 1}" for n in range(999)), "$a999 = x")
    assert any("1001" in problem.message for problem in grammar.problems())
    with pytest.raises(LanguageError, match="1001"):
        grammar.size()


def test_a_grammar_without_main_says_so():
    assert "no $Main" in grammar_of("$a = x").problems()[0].message


def test_a_grammar_of_a_trillion_answers_at_once_and_refuses_to_be_enumerated():
    grammar = huge_grammar()
    assert grammar.problems() == ()
    assert grammar.size() == 10**12
    with pytest.raises(LanguageError, match="1,000,000,000,000"):
        grammar.commands(limit=10_000)
    assert len(list(islice(grammar.commands(), 5))) == 5


def test_a_size_of_hundreds_of_digits_is_counted_exactly_and_said_as_a_power():
    grammar = grammar_of("$Main = " + "(a | b) " * 500)
    assert grammar.size() == 2**500
    with pytest.raises(LanguageError, match=r"10\^150"):
        grammar.commands(limit=10)


def test_nothing_is_streamed_out_of_a_trillion_times_nothing():
    grammar = grammar_of(
        "$Main = " + "$digit " * 12 + "$lost | b", "$digit = " + " | ".join("abcdefghij")
    )
    assert (grammar.size(), list(grammar.commands())) == (1, ["b"])


@given(small_grammars())
def test_the_stream_equals_a_naive_expansion_and_the_size_bounds_it(grammar):
    commands = list(grammar.commands())
    expected = {" ".join(words) for words, _ in naive(grammar, (Nonterminal("Main"),))} - {""}
    assert set(commands) == expected
    assert len(commands) == len(expected) <= grammar.size()


def test_problems_are_looked_for_once():
    grammar = grammar_of("$Main = $a | x", "$a = x", "$b = y")
    assert grammar.problems() is grammar.problems()


@pytest.mark.parametrize(
    ("text", "column", "commands"),
    [
        ("$Main = a\n$Main =", 8, ["a"]),
        ("$Main = a\n$Main =  \t", 8, ["a"]),
        ("$Main = a\n$Main = b (c | d) e)", 20, ["a", "b c e", "b d e"]),
        ("$Main = a\n$Main = b)) ", 10, ["a", "b"]),
    ],
)
def test_what_the_generator_reads_without_a_word_is_a_warning(text, column, commands):
    file = read_productions(text, "rules.txt")
    (problem,) = file.problems
    assert not problem.is_error and problem.position == Position("rules.txt", 2, column)
    assert list(Grammar(file.productions).commands()) == commands


@pytest.mark.parametrize("text", [r"$Main = a \)", r"$Main = (a\))", "$Main = {void meta: a)} b"])
def test_a_parenthesis_that_is_meant_is_no_problem(text):
    assert read_productions(text, "rules.txt").problems == ()


@pytest.mark.parametrize(
    ("glued", "apart"),
    [
        ("{object1}", "{object 1}"),
        ("{location beacon12?}", None),
        ("{KObject7 meta: x}", "{kobject 7 meta: x}"),
    ],
)
def test_an_id_may_be_glued_to_what_is_before_it(glued, apart):
    if apart is None:
        with pytest.raises(LanguageError):
            read_production(f"$Main = {glued}")
    else:
        assert print_production(read_production(f"$Main = {glued}")) == f"$Main = {apart}"
