"""The grammar oracle: parsing a command gives the forms that generating it would have given."""

from hypothesis import assume, given
from hypothesis import strategies as st

from annotations.language.grammar import Budget, Lattice
from annotations.language.templates import TaskCategory, TemplateChart, generate, read_template
from annotations.language.templates.chart import ChartDerivation
from annotations.language.templates.expansion import generation_size
from tests.annotations.language.grammar.test_grammar import huge_grammar
from tests.annotations.language.random_grammars import FEW, TOKENS, small_grammars
from tests.annotations.language.templates.test_expansion import category, small_templates


def test_the_derivation_to_keep_comes_first():
    chart = TemplateChart(
        [category("1", "go = (go)", "(go | run) = (run)"), category("2", "go = (walk)")]
    )
    assert chart.parse("go") == [
        ChartDerivation("( run )", "1", 1),
        ChartDerivation("( go )", "1", 0),
        ChartDerivation("( walk )", "2", 0),
    ]
    assert chart.parse("run") == [ChartDerivation("( run )", "1", 1)]


def test_slots_of_the_form_are_filled_from_the_command():
    chart = TemplateChart(
        [category("1", "$fetch the $thing $where = (put $thing (λ$1:e ($where $1)))")]
    )
    (derivation,) = chart.parse("bring the blue one left of")
    assert derivation.form_text == '( put " blue one " ( lambda $1 e ( left_of $1 ) ) )'


def test_a_command_that_no_template_derives_has_no_derivation():
    chart = TemplateChart([category("1", "go = (go)")])
    assert chart.parse("go go") == chart.parse("stay") == chart.parse("") == []


def test_a_grammar_of_a_trillion_parses_a_sentence_at_once():
    template = read_template("$Main = (go)")
    chart = TemplateChart([TaskCategory("1", huge_grammar(), (template,))])
    assert chart.parse("go " + " ".join(["w7"] * 12)) == [ChartDerivation("( go )", "1", 0)]


@given(
    small_grammars(),
    st.lists(small_templates(), max_size=3),
    st.lists(st.lists(st.sampled_from(TOKENS), max_size=4), max_size=10),
)
def test_parsing_is_the_inverse_of_generating(grammar, templates, others):
    one = TaskCategory("1", grammar, tuple(templates))
    assume(generation_size([one]) <= FEW)
    generated = {each.command: each for each in generate([one]).expansions}
    chart = TemplateChart([one])
    for command, expansion in generated.items():
        kept = chart.parse(command)[0]
        assert (kept.form_text, kept.template_index) == (
            expansion.form_text,
            expansion.template_index,
        )
    for command in map(" ".join, others):
        assert bool(chart.parse(command)) == (command in generated)


def test_spans_are_the_commands_inside():
    chart = TemplateChart(
        [category("1", "go = (go)", "go back = (back)"), category("2", "run away = (run)")]
    )
    lattice = Lattice.of_words(["please", "go", "back", "and", "run", "away"])
    assert chart.spans(lattice) == {(1, 2), (1, 3), (4, 6)}
    assert chart.beginnings == {"go", "run"}
    assert chart.spans(lattice, Budget(1)) < chart.spans(lattice)


@given(
    small_grammars(),
    st.lists(small_templates(), max_size=3),
    st.lists(st.sampled_from(TOKENS), max_size=6),
)
def test_what_has_a_derivation_is_a_span(grammar, templates, words):
    chart = TemplateChart([TaskCategory("1", grammar, tuple(templates))])
    places = [(start, end) for end in range(len(words) + 1) for start in range(end)]
    derived = {place for place in places if chart.parse(" ".join(words[slice(*place)]))}
    assert derived <= chart.spans(Lattice.of_words(words))
