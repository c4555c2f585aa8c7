"""A generator folder as a whole: what goes with what, and which problems are said once."""

from annotations.language.templates import read_generator_files


def read(**texts):
    return read_generator_files({f"{name}.txt": text.encode() for name, text in texts.items()})


def messages(folder):
    return [str(problem) for problem in folder.problems]


def test_each_category_has_its_grammar_with_imports_and_the_templates_of_its_set():
    folder = read(
        common_rules="$go = go",
        category_1_grammar="; import common.txt\n$Main = $go",
        category_1_semantics="$go = (go)",
        category_2_grammar="; import common.txt\n$Main = $go now",
        category_2_semantics="$go now = (go)\n$go soon = (go)",
    )
    assert folder.problems == ()
    categories = [
        (each.name, len(each.templates), each.grammar.size()) for each in folder.categories()
    ]
    assert categories == [("1", 1, 1), ("2", 3, 1)]


def test_a_shared_rule_is_unreachable_only_where_no_category_reaches_it():
    folder = read(
        common_rules="$go = go\n$never = x",
        a="; import common.txt\n$Main = $go",
        b="; import common.txt\n$Main = stay",
    )
    assert messages(folder) == [
        "common_rules.txt:2:1: warning: $Main never reaches $never (use it or remove it)"
    ]


def test_a_cycle_of_any_category_is_an_error_once():
    folder = read(common_rules="$go = $go", a="; import common.txt\n$Main = $go", b="$Main = stay")
    assert folder.has_errors
    assert [each for each in messages(folder) if "error" in each] == [
        "common_rules.txt:1:7: error: a cycle: $go → $go "
        "(a command grammar has to be finite: remove one of these references)"
    ]


def test_a_malformed_main_is_one_error_and_not_also_a_missing_main():
    assert messages(read(a="$Main = (x")) == [
        "a.txt:1:9: error: the choice opened here is never closed (add a ), or write \\( for the character itself)"
    ]
    assert any(
        each.startswith("a.txt:1:1: error: ") and "$Main" in each
        for each in messages(read(a="$x = y"))
    )


def test_templates_without_a_grammar_are_a_warning_and_malformed_ones_errors():
    folder = read(a="$Main = go", b_semantics="go = (go)", a_semantics="go = (go\nstay = (stay)")
    assert any(each.startswith("b_semantics.txt:1:1: warning: ") for each in messages(folder))
    (error,) = (problem for problem in folder.problems if problem.is_error)
    assert str(error.position) == "a_semantics.txt:1:9"


def test_two_files_cannot_make_one_task_category():
    folder = read_generator_files({"x.txt": b"$Main = go", "x_grammar.txt": b"$Main = stop"})
    (problem,) = folder.problems
    assert problem.is_error
    assert str(problem).startswith(
        "x_grammar.txt:1:1: error: the task category x already comes from x.txt"
    )
