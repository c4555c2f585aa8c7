"""Samples of a large language: derivations have numbers, and a seed chooses among these."""

from collections import Counter
from random import Random

import pytest
from hypothesis import assume, given

from annotations.language.grammar import Grammar, read_productions
from annotations.language.templates import (
    EVERYTHING,
    Balance,
    Language,
    RankedGrammar,
    SampleNote,
    SampleRequest,
    TaskCategory,
    TemplateExpander,
    generate,
    read_generator_folder,
    read_template,
)
from annotations.language.templates.sampling import shuffled
from annotations.language.texts.errors import LanguageError
from tests.annotations.language.grammar.test_grammar import huge_grammar
from tests.annotations.language.random_grammars import FEW, small_grammars
from tests.annotations.language.templates.test_expansion import small_templates

RULES = """
$Main = $goto and $hasobj
$place = put | place
$hasobj = $place it on the {placement} | bring it to $who
$goto = ( go | drive ) to the {room}
$who = me | $n | a $c person
$n = {name} | me
$c = red | blue
"""
TURNED = """
$c = blue | red
$n = me | {name}
$who = a $c person | $n | me
$goto = ( drive | go ) to the {room}
$hasobj = bring it to $who | $place it on the {placement}
$place = place | put
$Main = $goto and $hasobj
"""
GRAMMAR = Grammar(read_productions(RULES).productions)
LINES = (
    "$hasobj -> $place it on the {placement} = (put it {placement})",
    "$hasobj -> $place it on the {placement} and $then = (sequence (put it {placement}) $then)",
    "$then -> wait = (wait)",
    "$then -> greet $who = (greet $who)",
    "$hasobj -> bring it to $who and tell $who = (bring it $who)",
)
TEMPLATES = (
    "( go | drive ) to the {room} and $hasobj = (sequence (go {room}) $hasobj)",
    "find $who $who = (find $who)",
    "find $who or $n = (find $who $n)",
    "find ( $who | $c ) or $n and $c = (find $who $n $c)",
    "find me me = (find {object})",
)
# χ² with 11 degrees of freedom is above this once in ten thousand times.
CHI_SQUARE_OF_11 = 37.4


def category(*lines, grammar=GRAMMAR, name="one"):
    return TaskCategory(name, grammar, tuple(map(read_template, lines)))


COMPOSED = category(*LINES, *TEMPLATES)


def drawn(categories, size, seed=0, balance=Balance.NONE):
    return Language(categories).sample(SampleRequest(size, seed, balance))


def commands(sample):
    return {each.command for each in sample.generated.expansions}


def chi_square(counts, expected):
    return sum((count - expected) ** 2 / expected for count in counts)


@pytest.mark.parametrize("line", TEMPLATES)
def test_every_number_is_another_derivation_and_all_of_them_are_what_expansion_gives(line):
    ranked = RankedGrammar(GRAMMAR, COMPOSED.lines).template(read_template(line))
    derivations = [ranked.derivation(rank) for rank in range(ranked.size)]
    assert len(set(derivations)) == ranked.size
    pairs = {(" ".join(words), form) for words, form in map(ranked.pair, derivations)}
    assert pairs == set(TemplateExpander(GRAMMAR, COMPOSED.lines).pairs(read_template(line)))
    with pytest.raises(IndexError):
        ranked.derivation(ranked.size)


@pytest.mark.parametrize("line", TEMPLATES)
def test_classes_of_one_form_have_every_derivation_once(line):
    ranked = RankedGrammar(GRAMMAR, COMPOSED.lines).template(read_template(line))
    classes = list(ranked.form_classes())
    of_classes = [
        [ranked.derivation_of(form, rank) for rank in range(form.size)] for form in classes
    ]
    assert len({each for some in of_classes for each in some}) == ranked.size
    assert all(len({ranked.pair(each)[1] for each in some}) == 1 for some in of_classes)
    assert ranked.n_forms == len(classes)


@pytest.mark.parametrize("line", TEMPLATES)
def test_a_command_leads_back_to_its_derivations_and_these_to_wildcards(line):
    ranked = RankedGrammar(GRAMMAR, COMPOSED.lines).template(read_template(line))
    for rank in range(ranked.size):
        derivation = ranked.derivation(rank)
        words, form = ranked.pair(derivation)
        assert derivation in list(ranked.derivations_of(words, form))
        intact = ranked.intact(derivation, 7)
        assert {each.anonymized_text for each in intact} == {" ".join(words)}
        assert {each.template_index for each in intact} == {7}


@given(small_grammars(), small_templates())
def test_numbers_are_the_derivations_of_any_grammar(grammar, template):
    expander = TemplateExpander(grammar)
    assume(expander.size(template) <= FEW)
    ranked = RankedGrammar(grammar).template(template)
    assert ranked.size <= expander.size(template)
    pairs = {ranked.pair(ranked.derivation(rank)) for rank in range(ranked.size)}
    texts = {(" ".join(words), form) for words, form in pairs if words}
    assert texts == set(expander.pairs(template))


def test_a_language_says_its_size_without_making_a_command():
    digits = category("go " + "$digit " * 12 + "= (go)", grammar=huge_grammar())
    assert Language([digits]).size == 10**12


def test_combinations_that_disagree_about_a_nonterminal_are_not_counted():
    assert Language([category("find $who $who = (find $who)")]).size == 5


def test_a_sample_of_a_huge_language_has_as_many_commands_as_asked_for():
    digits = category("go " + "$digit " * 12 + "= (go)", grammar=huge_grammar())
    sample = drawn([digits], 500)
    assert len(commands(sample)) == 500
    assert (sample.note.commands, sample.note.of) == (500, 10**12)
    assert not sample.note.is_all
    assert str(sample.note) == "a sample of 500 of 1,000,000,000,000"


@pytest.mark.parametrize("balance", Balance)
def test_a_sample_of_everything_is_what_full_generation_gives(balance):
    full = generate([COMPOSED], None)
    sample = drawn([COMPOSED], 10_000, 3, balance)
    assert set(sample.generated.expansions) == set(full.expansions)
    assert set(sample.generated.conflicts) == set(full.conflicts)
    assert full.conflicts
    assert sample.note.is_all


@pytest.mark.parametrize("balance", Balance)
def test_a_sample_of_everything_of_2018_is_what_full_generation_gives(shared_data, balance):
    categories = read_generator_folder(shared_data / "generator-2018").categories()
    full = generate(categories)
    sample = drawn(categories, 10_000, 1, balance)
    assert set(sample.generated.expansions) == set(full.expansions)
    assert set(sample.generated.conflicts) == set(full.conflicts)


@pytest.mark.parametrize("balance", Balance)
def test_every_command_of_a_sample_has_the_form_of_full_generation(balance):
    forms = {each.command: each for each in generate([COMPOSED], None).expansions}
    sample = drawn([COMPOSED], 25, 4, balance)
    assert len(commands(sample)) == 25
    assert all(forms[each.command] == each for each in sample.generated.expansions)


@pytest.mark.parametrize("balance", Balance)
def test_a_seed_decides_and_a_larger_sample_begins_with_a_smaller_one(balance):
    assert drawn([COMPOSED], 20, 5, balance) == drawn([COMPOSED], 20, 5, balance)
    assert commands(drawn([COMPOSED], 20, 5, balance)) != commands(
        drawn([COMPOSED], 20, 6, balance)
    )
    assert commands(drawn([COMPOSED], 20, 5, balance)) < commands(drawn([COMPOSED], 30, 5, balance))


@pytest.mark.parametrize("balance", Balance)
def test_the_order_of_lines_and_alternatives_does_not_matter(balance):
    other = Grammar(read_productions(TURNED).productions)
    lines = [line for line in TEMPLATES if "or $n" in line]
    one = drawn([category(*lines)], 9, 2, balance)
    two = drawn([category(*lines[::-1], grammar=other)], 9, 2, balance)
    assert other.rules != GRAMMAR.rules
    assert commands(one) == commands(two)


def test_derivations_are_drawn_uniformly():
    # Twelve commands, in alternatives of different sizes; the χ² test at one failure in ten thousand.
    rules = "$Main = go $a $b\n$a = one | $rest\n$rest = two | three | $more\n$more = 4 | 5 | 6\n$b = x | y"
    twelve = category("go $a $b = (go)", grammar=Grammar(read_productions(rules).productions))
    counts = Counter(
        command for seed in range(600) for command in commands(drawn([twelve], 2, seed))
    )
    assert len(counts) == 12
    assert chi_square(counts.values(), 100) < CHI_SQUARE_OF_11


def test_lines_have_equally_many_commands_and_small_ones_all_they_have():
    wide = "go " + "$digit " * 12
    categories = [
        category(
            f"{wide} = (go)",
            f"{wide} later = (postpone)",
            "wait $digit = (wait)",
            grammar=huge_grammar(),
        )
    ]
    sample = drawn(categories, 90, balance=Balance.LINES)
    counts = Counter(each.template_index for each in sample.generated.expansions)
    assert counts == {0: 40, 1: 40, 2: 10}


def test_lines_of_nonterminals_are_balanced_too():
    wide = "$wide -> go " + "$digit " * 12 + "= (go)"
    narrow = "$wide -> stop $digit $digit $digit = (stop)"
    of_lines = category(wide, narrow, "please $wide = $wide", grammar=huge_grammar())
    sample = drawn([of_lines], 100, balance=Balance.LINES)
    counts = Counter(each.form_text for each in sample.generated.expansions)
    assert counts == {"( go )": 50, "( stop )": 50}
    uniform = drawn([of_lines], 100)
    assert {each.form_text for each in uniform.generated.expansions} == {"( go )"}


def test_forms_have_equally_many_commands():
    wide = "$digit " * 6
    of_forms = category(
        f"go {wide} = (go)", "wait {room} $digit = (wait $digit)", grammar=huge_grammar()
    )
    sample = drawn([of_forms], 31, balance=Balance.FORMS)
    counts = Counter(each.form_text for each in sample.generated.expansions)
    assert counts.pop("( go )") == 21
    assert len(counts) == 10
    assert set(counts.values()) == {1}


def test_too_many_forms_to_balance_are_refused():
    form = "(go " + " ".join(f"$d{number}" for number in range(6)) + ")"
    rules = "$Main = go\n" + "\n".join(
        f"$d{number} = " + " | ".join(f"w{word}" for word in range(10)) for number in range(6)
    )
    grammar = Grammar(read_productions(rules).productions)
    many = category(form.replace("(go", "go").rstrip(")") + " = " + form, grammar=grammar)
    with pytest.raises(LanguageError):
        drawn([many], 10, balance=Balance.FORMS)
    assert len(commands(drawn([many], 10, balance=Balance.LINES))) == 10


def test_a_template_that_cannot_be_stored_is_left_out():
    bad = category(
        "say $x now = ($x)",
        "wait = (wait)",
        grammar=Grammar(read_productions("$Main = wait\n$x = ,").productions),
    )
    sample = drawn([bad], 10)
    assert commands(sample) == {"wait"}
    assert [each.template_index for each in sample.generated.left_out] == [0]


def test_many_nonterminals_that_may_be_absent_are_refused_not_counted_for_ever():
    names = [f"n{number}" for number in range(30)]
    rules = "$Main = go\n" + "\n".join(f"${name} = a | b" for name in names)
    grammar = Grammar(read_productions(rules).productions)
    line = " ".join(f"( ${name} | {{void}} )" for name in names)
    hostile = category(f"{line} = (go {' '.join('$' + name for name in names)})", grammar=grammar)
    language = Language([hostile])
    assert language.size == 0
    assert [each.template_index for each in language.left_out] == [0]


def test_a_sample_of_nothing_is_refused():
    with pytest.raises(LanguageError):
        Language([COMPOSED]).sample(EVERYTHING)


def test_a_language_without_commands_gives_an_empty_sample():
    sample = drawn([category("find $nothing = (find)")], 5)
    assert (sample.generated.expansions, sample.note.commands) == ((), 0)


@pytest.mark.parametrize("size", [0, 1, 7, 100])
def test_a_shuffle_has_every_number_once(size):
    assert sorted(shuffled(size, Random(1))) == list(range(size))


def test_a_shuffle_of_very_many_begins_at_once():
    numbers = shuffled(10**100, Random(1))
    assert len({next(numbers) for _ in range(100)}) == 100


@pytest.mark.parametrize("balance", Balance)
def test_what_is_remembered_of_a_sample_reads_back(balance):
    note = SampleNote(SampleRequest(5, 2**63 - 1, balance), 4, 10**40, is_all=True)
    assert SampleNote.from_json(note.as_json()) == note
    assert SampleNote.from_json({}) is None


def test_a_language_of_endless_size_is_remembered_as_very_large():
    stored = SampleNote(SampleRequest(5), 5, 10**9_000).as_json()
    note = SampleNote.from_json(stored)
    assert note is not None
    assert note.of == 10**4_000


@pytest.mark.parametrize(
    "change",
    [
        {"of": "-1"},
        {"of": 5},
        {"seed": True},
        {"size": 2**63},
        {"balanced": "x"},
        {"is_all": 1},
        {"a": 1},
    ],
)
def test_what_is_no_note_about_a_sample_is_refused(change):
    stored = SampleNote(SampleRequest(5), 5, 100).as_json()
    with pytest.raises(ValueError):
        SampleNote.from_json({**stored, **change})
