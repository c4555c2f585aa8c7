"""Semantic templates: reading their lines, and the problems of one and of many together."""

import pytest

from annotations.language.forms import Nonterminal, Wildcard, read_form
from annotations.language.grammar import Grammar, read_productions
from annotations.language.templates import (
    TaskCategory,
    generate,
    make_template,
    print_template,
    read_template,
    set_problems,
)
from annotations.language.templates.template_checks import problems
from annotations.language.templates.templates import read_templates
from annotations.language.texts.errors import LanguageError, Position
from annotations.language.texts.limits import MAX_NESTING
from annotations.language.world import infer_signatures
from tests.annotations.language.grammar.test_grammar import huge_grammar

GRAMMAR = Grammar(
    read_productions(
        "$Main = $fetch the $thing | find {name} | follow {pron} now | $fetch $lost\n"
        "$fetch = get | bring\n"
        "$thing = {object} | $colour one\n"
        "$colour = red | blue"
    ).productions
)


def problems_of(line, predicates=None):
    template = read_template(line, Position("t.txt", 4))
    return [str(problem) for problem in problems(template, GRAMMAR, predicates)]


def only(line, predicates=None):
    (problem,) = problems_of(line, predicates)
    return problem


def test_a_line_is_a_pattern_and_a_form_and_knows_where_both_begin():
    template = read_template("  find {name} =  (find {name})  # said often", Position("t.txt", 4))
    assert (template.pattern_text, template.form_text) == ("find {name}", "(find {name})")
    assert template.form == read_form("(find {name})")
    assert template.position == Position("t.txt", 4, 3)
    assert template.form_position == Position("t.txt", 4, 18)


def test_an_equals_sign_in_braces_and_an_escaped_one_separate_nothing():
    template = read_template(r"a \= {object where fruit=true} = (find {object})")
    assert template.pattern[1].value == "="
    assert template.pattern[2].where.value is True


def test_comments_and_blank_lines_are_skipped_and_positions_counted():
    templates, troubles = read_templates("# one\n\nfind = (go)\n", "t.txt")
    assert not troubles
    assert [template.position.line for template in templates] == [3]


def test_a_template_printed_and_read_is_equal():
    line = "bring (me | to {name 1}), please = (bring (λ$1:e (is_a $1 $thing) ($oprop $1)))"
    template = read_template(line)
    assert read_template(print_template(template)).pattern == template.pattern
    assert read_template(print_template(template)).form == template.form


def test_slots_are_nonterminals_and_wildcards_of_the_form_in_order():
    template = read_template("a = (bring (λ$1:e ($oprop $1) (is_a $1 $thing) (at $1 {room})))")
    assert list(template.slots()) == [
        Nonterminal("oprop"),
        Nonterminal("thing"),
        Wildcard("room"),
    ]
    assert template.tracked == {"oprop", "thing"}


@pytest.mark.parametrize(
    ("line", "column", "named"),
    [
        ("find {name}", 1, " = "),
        ("a = b = (go)", 7, " 2 "),
        (" = (go)", 1, ""),
        ("go = ", 6, ""),
        ("go ( = (go)", 4, ""),
        ("go {nam} = (go)", 5, "{name}"),
        ("go = (go", 9, ""),
        ("go = (find (λ$1:e (is_a $2 {room})))", 25, "$2"),
        ("go = (go {room 1 2})", 18, ""),
    ],
)
def test_a_line_that_is_no_template_is_an_error_with_its_place(line, column, named):
    _, (problem,) = read_templates(f"go = (go)\n{line}", "t.txt")
    assert problem.is_error
    assert named in str(problem)
    assert problem.position == Position("t.txt", 2, column)


def test_five_thousand_parentheses_are_refused_on_either_side():
    deep = "(" * 2_000 + ")" * 2_000
    for line in (f"{deep} = (go)", f"go = {deep}"):
        with pytest.raises(LanguageError, match=rf"\b{MAX_NESTING}\b"):
            read_template(line)


def test_a_file_of_something_else_is_one_error_and_one_of_comments_a_warning():
    _, (problem,) = read_templates("<rooms>\n<room/>\n<room/>\n</rooms>", "t.txt")
    assert problem.is_error and problem.position.source == "t.txt"
    _, (problem,) = read_templates("# nothing yet", "t.txt")
    assert not problem.is_error


def test_two_sides_kept_apart_make_the_same_template():
    assert make_template("find {name}", "(find {name})") == read_template(
        "find {name} = (find {name})"
    )


def test_a_template_that_fits_has_no_problems():
    assert problems_of("find {name} = (find {name})") == []
    assert problems_of("$fetch the $thing = (bring $thing)") == []
    assert problems_of("follow {pron} now = (follow (λ$1:e (person $1)))") == []


@pytest.mark.parametrize("slot", ["$fetch", "{room}", "{name 1}"])
def test_a_slot_that_only_the_form_has_is_an_error(slot):
    problem = only(f"find {{name}} = (find {{name}} {slot})")
    assert problem.startswith("t.txt:4:28: error: ")
    assert f" {slot}" in problem


def test_a_nonterminal_that_the_pattern_produces_further_down_may_be_a_slot():
    assert problems_of("$fetch the $colour one = (bring $colour)") == []
    assert problems_of("$fetch the {object} = (bring {object} )") == []


def test_a_wildcard_that_the_form_leaves_out_is_a_warning_pronouns_and_unknown_excepted():
    problem = only("find {name} = (find)")
    assert problem.startswith("t.txt:4:6: warning: ") and "{name}" in problem
    assert "{object}" in only("$fetch the $thing = (bring)")
    assert problems_of("find {name} = UNKNOWN") == []


def test_commands_outside_the_grammar_are_counted_with_an_example():
    problem = only("(find | seek) {name} = (find {name})")
    assert "1 of 2 commands " in problem and '"seek <name>"' in problem
    whole = only("seek {name} = (find {name})")
    assert "warning: " in whole and '"seek <name>"' in whole and "commands" not in whole


def test_a_template_of_a_trillion_commands_is_checked_at_once():
    template = read_template("$Main $Main = (go)")
    too_many, problem = problems(template, huge_grammar())
    assert " 1,000,000" in too_many.message and not too_many.is_error
    assert not problem.is_error


def test_an_undefined_nonterminal_in_a_pattern_is_a_warning():
    first, second = problems_of("$fetch $lost = (bring)")
    assert first.startswith("t.txt:4:8: warning: ") and "$lost" in first
    assert ": warning: " in second and "$lost" not in second


def test_a_predicate_that_is_not_declared_or_takes_something_else_is_a_warning():
    declared = infer_signatures([read_form("(find {name})"), read_form("(go {room})")])
    assert " fined" in only("find {name} = (fined {name})", declared)
    assert " 2 " in only("find {name} = (find {name} 1)", declared)


def test_a_predicate_slot_that_becomes_no_name_is_an_error():
    problem = problems_of("$fetch the $thing = (bring (λ$1:e ($thing $1)))")[-1]
    assert "error: $thing " in problem


def test_duplicates_and_conflicts_inside_a_set_are_reported_with_the_other_place():
    text = (
        "find {name} = (find {name})\n"
        "find {name} = (find {name})\n"
        "(find | follow) {name} = (look_for {name})"
    )
    category = TaskCategory("1", GRAMMAR, read_templates(text, "t.txt")[0])
    troubles = [str(each) for each in set_problems([category], generate([category]))]
    (duplicate,) = [each for each in troubles if each.startswith("t.txt:2:1: warning: ")]
    (conflict,) = [each for each in troubles if each.startswith("t.txt:3:1: warning: 1 command ")]
    assert "t.txt:1:1" in duplicate
    assert all(named in conflict for named in ('"find <name>"', "t.txt:2:1"))
