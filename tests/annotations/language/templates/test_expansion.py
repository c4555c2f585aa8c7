"""Synchronous expansion: commands with their forms, anonymized or with their wildcards intact."""

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from annotations.language.forms import (
    Application,
    Constant,
    Lambda,
    Nonterminal,
    Variable,
    Wildcard,
    canonical_text,
    print_sequence,
    read_form,
    to_template,
)
from annotations.language.grammar import Grammar, read_productions
from annotations.language.templates import (
    GrammarExpansions,
    SemanticTemplate,
    TaskCategory,
    TemplateExpander,
    generate,
    read_template,
)
from annotations.language.templates.expansion import generation_size
from annotations.language.texts.errors import LanguageError
from tests.annotations.language.grammar.test_grammar import huge_grammar
from tests.annotations.language.random_grammars import (
    FEW,
    LAYERS,
    naive,
    sequences_over,
    small_grammars,
)

GRAMMAR = Grammar(
    read_productions(
        "$Main = $fetch the $thing | go to the {room 1}\n"
        "$fetch = get | bring {void meta: from the {room 2}}\n"
        "$thing = {kobject} | {aobject} | $colour one\n"
        "$colour = red | blue\n"
        "$where = left of | above"
    ).productions
)


def pairs(line, grammar=GRAMMAR):
    return list(dict.fromkeys(TemplateExpander(grammar).pairs(read_template(line))))


def derivations(line):
    return [
        (print_sequence(each.symbols), to_template(each.form))
        for each in TemplateExpander(GRAMMAR).derivations(read_template(line))
    ]


def category(name, *lines, grammar=GRAMMAR):
    return TaskCategory(name, grammar, tuple(map(read_template, lines)))


def test_a_nonterminal_in_both_sides_becomes_the_same_in_both():
    assert pairs("(bring | get) the $thing = (bring $thing)") == [
        ("bring the <object>", '( bring " <object> " )'),
        ("bring the red one", '( bring " red one " )'),
        ("bring the blue one", '( bring " blue one " )'),
        ("get the <object>", '( bring " <object> " )'),
        ("get the red one", '( bring " red one " )'),
        ("get the blue one", '( bring " blue one " )'),
    ]


def test_every_occurrence_of_a_nonterminal_of_the_form_becomes_the_same():
    commands = [command for command, _ in pairs("$colour or $colour = (paint $colour)")]
    assert commands == ["red or red", "blue or blue"]
    assert len(pairs("$colour or $colour = (paint)")) == 4


def test_a_nonterminal_further_down_is_found_and_what_lacks_it_left_out():
    assert pairs("take the $thing = (take $colour)") == [
        ("take the red one", '( take " red " )'),
        ("take the blue one", '( take " blue " )'),
    ]


def test_a_predicate_slot_becomes_a_name_with_underscores():
    assert pairs("put it $where = (put (λ$1:e ($where $1)))") == [
        ("put it left of", "( put ( lambda $1 e ( left_of $1 ) ) )"),
        ("put it above", "( put ( lambda $1 e ( above $1 ) ) )"),
    ]


def test_wildcards_become_class_tokens_and_words_quoted_constants():
    assert pairs(
        'follow {pron} to {beacon 2}, {room}, {kobject?} = (go {beacon 2} {room} "x" 3)'
    ) == [
        (
            "follow them to <location> , <room> , <object>",
            '( go " <location> " " <room> " " x " 3 )',
        )
    ]


def test_forms_are_canonical():
    ((_, form),) = pairs("go = (go (λ$2:e (at $2 (λ$1:e (is $1 $2)))))")
    assert form == "( go ( lambda $1 e ( at $1 ( lambda $2 e ( is $2 $1 ) ) ) ) )"


def test_with_wildcards_intact_slots_stay_bare_and_notes_stay_in_the_command():
    assert derivations("$fetch the {kobject 1 meta: hidden} = (bring {kobject 1})") == [
        ("get the {kobject 1 meta: hidden}", "(bring {kobject 1})"),
        (
            "bring {void meta: from the {room 2}} the {kobject 1 meta: hidden}",
            "(bring {kobject 1})",
        ),
    ]


def test_with_wildcards_intact_a_nonterminal_slot_becomes_its_wildcard_or_its_words():
    assert derivations("get the $thing = (bring $thing)") == [
        ("get the {kobject}", "(bring {kobject})"),
        ("get the {aobject}", "(bring {aobject})"),
        ("get the red one", '(bring "red one")'),
        ("get the blue one", '(bring "blue one")'),
    ]


def test_derivations_say_which_anonymized_command_they_are_of():
    expander = TemplateExpander(GRAMMAR)
    template = read_template("$fetch the $thing = (bring $thing)")
    texts = {each.anonymized_text for each in expander.derivations(template, 7)}
    assert texts == {command for command, _ in expander.pairs(template)}
    assert {each.template_index for each in expander.derivations(template, 7)} == {7}


def test_a_later_template_wins_and_the_conflict_names_both_forms():
    generated = generate([category("1", "go = (go)", "(go | run) = (run)", "go = (run)")])
    assert {each.command: each.form_text for each in generated.expansions} == {
        "go": "( run )",
        "run": "( run )",
    }
    (conflict,) = generated.conflicts
    assert (conflict.command, conflict.kept) == ("go", "( run )")
    assert conflict.candidates == ((0, "( go )"), (2, "( run )"))


def test_a_command_belongs_to_the_first_category_that_has_it_and_keeps_its_form():
    generated = generate([category("1", "go = (go)"), category("2", "go = (run)", "run = (run)")])
    expansions = [
        (each.command, each.task_category, each.form_text) for each in generated.expansions
    ]
    assert expansions == [("go", "1", "( go )"), ("run", "2", "( run )")]
    assert generated.conflicts == ()


def test_commands_outside_the_grammar_are_kept_and_said_to_be_so():
    generated = generate(
        [category("1", "(get | seize) the {kobject} = (bring {kobject})", "x = (x)")]
    )
    assert [each.command for each in generated.outside_grammar] == ["seize the <object>", "x"]
    assert len(generated.expansions) == 3
    assert generated.unmatched == (("1", 1),)


def test_a_template_is_matched_where_any_category_with_it_derives_a_command():
    other = Grammar(read_productions("$Main = x").productions)
    first, second = category("1", "x = (x)"), category("2", "x = (x)", grammar=other)
    assert generate([first]).unmatched == (("1", 0),)
    assert generate([first, second]).unmatched == ()


def test_a_template_of_a_trillion_pairs_is_left_out_with_their_number():
    huge = category("1", "x = (x)", "$Main = (go)", grammar=huge_grammar())
    assert generation_size([huge], limit=None) == 10**12 + 1
    generated = generate([huge], limit=1_000_000)
    assert [each.command for each in generated.expansions] == ["x"]
    (left,) = generated.left_out
    assert (left.task_category, left.template_index) == ("1", 1)
    assert "1,000,000,000,000 commands" in left.problem.message
    assert not left.problem.is_error
    assert next(TemplateExpander(huge.grammar).pairs(huge.templates[1]))[1] == "( go )"


def test_templates_that_are_too_many_together_are_refused():
    many = category("1", "(a|b|c) = (go)", "(d|e|f) = (run)")
    with pytest.raises(LanguageError, match=r"\b6\b.*\b5\b"):
        generate([many], limit=5)


def test_a_template_that_cannot_be_stored_is_left_out_alone():
    bad = category("1", "x = (x)", "$digits = ($digits)", grammar=with_digits())
    generated = generate([bad])
    assert [each.command for each in generated.expansions] == ["x"]
    (left,) = generated.left_out
    assert "used as a predicate" in left.problem.message


def with_digits():
    return Grammar(read_productions("$Main = x\n$digits = 7").productions)


def test_what_was_expanded_before_is_looked_up_and_gives_the_same():
    kept = {}

    def expansions(grammar, lines):
        return kept.setdefault(id(grammar), GrammarExpansions(grammar, lines, most_kept=1_000))

    one = category("1", "go = (go)", "(go | run) = (run)", "$fetch the $thing = (bring $thing)")
    other = category("1", "(go | run) = (run)", "go = (stop)")
    for categories in ([one], [other], [one, other], [one]):
        assert generate(categories, expansions=expansions) == generate(categories)


def test_a_cycle_is_refused():
    cyclic = Grammar(read_productions("$Main = $Main").productions)
    with pytest.raises(LanguageError, match=r"\$Main → \$Main"):
        generate([category("1", "go = (go)", grammar=cyclic)])


@st.composite
def small_templates(draw):
    """A pattern over a small grammar; its form mentions up to two of the nonterminals."""
    pattern = draw(sequences_over(LAYERS[1:]))
    slots = draw(st.lists(st.sampled_from(LAYERS[1:]), max_size=2, unique=True).map(sorted))
    arguments = (Constant("fixed"), Wildcard("object"), *map(Nonterminal, slots))
    form = Application("do", (Lambda(1, "e", (Application("is", (Variable(1), *arguments)),)),))
    return SemanticTemplate(pattern, form, print_sequence(pattern), to_template(form))


@given(small_grammars(), small_templates())
def test_the_stream_equals_a_naive_synchronous_expansion(grammar, template):
    expander = TemplateExpander(grammar)
    assume(expander.size(template) <= FEW)
    expected = set()
    for words, bound in naive(grammar, template.pattern):
        mentioned = {pair for pair in bound if pair[0] in template.tracked}
        if words and len(mentioned) == len(template.tracked) == len(dict(mentioned)):
            slots = {name: " ".join(value) or None for name, value in mentioned}
            form = to_template(template.form).replace("{object}", '"<object>"')
            for name, value in slots.items():
                form = form.replace(f"${name}", f'"{value}"' if value else "UNKNOWN")
            expected.add((" ".join(words), canonical_text(read_form(form))))
    streamed = list(expander.pairs(template))
    assert set(streamed) == expected
    assert len(streamed) <= expander.size(template)
    intact = {each.anonymized_text for each in expander.derivations(template)} - {""}
    assert intact == {command for command, _ in expected}
