"""Names and texts that no database column takes are refused where they are read."""

from dataclasses import dataclass
from xml.sax.xmlreader import Locator

import pytest

from annotations import models
from annotations.language.forms import read_form
from annotations.language.grammar import Grammar, Recognizer, read_production, read_productions
from annotations.language.templates import (
    TaskCategory,
    TemplateExpander,
    generate,
    make_template,
    read_generator_files,
    set_problems,
)
from annotations.language.templates.template_checks import problems
from annotations.language.texts import limits
from annotations.language.texts.decoding import decode
from annotations.language.texts.errors import LanguageError, Offsets, Position, Problem, Severity
from annotations.language.world import infer_signatures, ontology_files, read_ontology
from tests.work import growth

GRAMMAR = Grammar(read_productions("$Main = get the $thing\n$thing = " + "x" * 100).productions)


def test_the_limits_are_those_of_the_database():
    columns = {
        (models.Production, "nonterminal"): limits.MAX_NONTERMINAL,
        (models.Predicate, "name"): limits.MAX_PREDICATE,
        (models.Predicate, "gloss"): limits.MAX_GLOSS,
        (models.LogicalForm, "head_predicate"): limits.MAX_PREDICATE,
        (models.TaskCategory, "name"): limits.MAX_TASK_CATEGORY,
        (models.Command, "task_category"): limits.MAX_TASK_CATEGORY,
        (models.Production, "source"): limits.MAX_FILE_NAME,
        (models.SemanticTemplate, "source"): limits.MAX_FILE_NAME,
        (models.Entity, "source"): limits.MAX_FILE_NAME,
    }
    for (model, name), limit in columns.items():
        assert model._meta.get_field(name).max_length == limit, (model, name)


@pytest.mark.parametrize(
    "form",
    [
        f"({'p' * 81} UNKNOWN)",
        f"{'p' * 81}(UNKNOWN)",
        f"(go ${'n' * 121})",
        f"(${'n' * 121} UNKNOWN)",
        f'(go "{"x" * 5_000}")',
        "(go \x00)",
        '(go "\ud800")',
        '(go\n "a\x01b")',
    ],
)
def test_a_form_beyond_the_limits_is_refused(form):
    with pytest.raises(LanguageError):
        read_form(form)


def test_names_as_long_as_they_may_be_are_read():
    assert read_form(f"({'p' * 80} ${'n' * 120})")
    assert read_production(f"${'n' * 120} = ${'m' * 120}")


@pytest.mark.parametrize("line", [f"${'n' * 121} = a", f"$a = b ${'n' * 121}", "$a = b\x00c"])
def test_a_production_beyond_the_limits_is_a_problem_at_its_place(line):
    (problem,) = read_productions(f"$Main = $a\n{line}", "rules.txt").problems
    assert problem.position.line == 2


def test_a_predicate_that_a_nonterminal_makes_too_long_is_refused():
    template = make_template("get the $thing", "($thing UNKNOWN)", Position("t.txt", 3))
    (problem,) = problems(template, GRAMMAR)
    assert problem.is_error and "at most 80 characters" in problem.hint


def test_a_pattern_and_a_form_have_a_greatest_length():
    with pytest.raises(LanguageError, match="5,001"):
        make_template("x" * 5_001, "UNKNOWN")
    with pytest.raises(LanguageError, match="5,007"):
        make_template("x", f'(go "{"x" * 5_000}")')


@pytest.mark.parametrize(
    ("pattern", "form"), [("get " + "é" * 1_300, "(go)"), ("get", f'(go "{"x" * 2_600}")')]
)
def test_a_command_or_form_too_large_for_an_index_is_an_error(pattern, form):
    template = make_template(pattern, form, Position("t.txt", 3))
    with pytest.raises(LanguageError, match="2,500"):
        list(TemplateExpander(GRAMMAR).pairs(template))
    assert any(problem.is_error for problem in problems(template, GRAMMAR))


def test_a_task_category_of_a_long_file_name_is_an_error():
    files = {f"{'c' * 61}.txt": b"$Main = go"}
    (problem,) = read_generator_files(files).problems
    assert problem.is_error and "61" in problem.message
    with pytest.raises(LanguageError, match="201"):
        decode(b"text", "f" * 201)


def test_an_entity_with_a_long_text_is_an_error():
    files = {"names.xml": f"<names><name>{'n' * 501}</name></names>".encode()}
    (problem,) = read_ontology(files)[1]
    assert problem.is_error and "501 characters" in problem.message


def test_a_gloss_too_long_to_store_is_left_to_be_made_again():
    form = read_form(f"({'go_' * 26} {'UNKNOWN ' * 40})")
    (predicate,) = infer_signatures([form]).values()
    assert predicate.gloss == ""


def test_a_file_name_that_is_a_digit_but_no_number_is_a_name():
    folder = read_generator_files({"²_grammar.txt": b"$Main = go", "3.txt": b"$Main = stop"})
    assert [each.name for each in folder.compositions] == ["3", "²"]


class Piece(str):
    """Text that must not be added to other text: that copies all of it once for each piece."""

    def __radd__(self, text):
        pytest.fail("the text so far is copied for each piece")


def test_xml_text_in_pieces_is_joined_once():
    handler = ontology_files._Handler("names.xml")
    handler.setDocumentLocator(Locator())
    handler.startElement("name", {})
    for _ in range(3):
        handler.characters(Piece(" a"))
    handler.endElement("name")
    assert handler.root.text == "a a a"


def test_xml_text_cut_by_many_comments_is_read():
    text = "<names><name>" + "a<!---->" * 60_000 + "</name></names>"
    (problem,) = read_ontology({"names.xml": text.encode()})[1]
    assert "60,000 characters" in problem.message


def cyclic(length):
    chain = "".join(f"$a{n} = $a{n + 1} | $a0\n" for n in range(length))
    return Grammar(read_productions(f"$Main = $a0\n{chain}$a{length} = x").productions)


def test_many_cycles_are_reported_in_part():
    errors = [problem for problem in cyclic(2_000).problems() if problem.is_error]
    assert len(errors) == 50
    assert growth(lambda length: cyclic(length).problems, 500) < 2.5


def test_alternatives_that_can_be_nothing_are_numbered_in_linear_time():
    def number_and_accept(count):
        lines = " | ".join(f"($v|w{n}) ($v|x{n})" for n in range(count))
        grammar = Grammar(read_productions(f"$Main = {lines}\n$v = {{void}}").productions)

        def act():
            recognizer = Recognizer(grammar)
            assert recognizer.accepts("w7 x7") and not recognizer.accepts("w7 x8")

        return act

    assert growth(number_and_accept, 1_200) < 2.5  # more words than a rule keeps in its table


def test_many_forms_of_one_command_conflict_in_linear_time():
    def templates(count):
        return tuple(make_template("get the $thing", f"(go{n})") for n in range(count))

    def generate_from(count):
        category = TaskCategory("1", GRAMMAR, templates(count))
        return lambda: generate([category])

    assert growth(generate_from, 500) < 2.5
    (conflict,) = generate_from(5_000)().conflicts
    assert conflict.candidates[-1] == (4_999, "( go4999 )") and len(conflict.candidates) == 5_000


def test_a_check_of_the_grammar_that_takes_too_long_leaves_the_template_right():
    words = "\n".join(f"$Main = c w{n}" for n in range(1_000))
    grammar = Grammar(read_productions(words).productions)
    template = make_template("$Main", "(go)")
    assert not problems(template, grammar)
    assert not set_problems([TaskCategory("1", grammar, (template,))], generate([]))


@dataclass
class Place:
    index: int
    expected: Position


@pytest.mark.parametrize(
    "place",
    [Place(0, Position("a", 1, 1)), Place(2, Position("a", 1, 3)), Place(3, Position("a", 2, 1))],
)
def test_an_index_of_a_text_has_a_position(place):
    assert Offsets("ab\ncd", "a").position(place.index) == place.expected


def test_a_problem_of_no_file_has_no_numbers_in_front():
    assert str(Problem(Position(), Severity.ERROR, "no", "do")) == "error: no (do)"
    assert str(LanguageError("no")) == "error: no"
    assert str(Problem(Position("a.txt", 2, 3), Severity.WARNING, "no")) == "a.txt:2:3: warning: no"


def test_a_position_shows_its_line_with_a_caret():
    text = "one\n\tfind {objec}\n"
    assert Position("a.txt", 2, 7).excerpt(text) == " find {objec}\n      ^"
    assert Position("a.txt", 9, 1).excerpt(text) == ""
    shown, caret = Position("a.txt", 1, 2_000).excerpt("x" * 1_998 + "!y" + "x" * 900).split("\n")
    assert shown[len(caret) - 1] == "y" and len(shown) <= 80
