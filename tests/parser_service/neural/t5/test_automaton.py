"""Typed forms: none that the checker refuses, and each that it passes within the limits."""

import json
from itertools import product

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from annotations.language.corpus import read_pairs
from annotations.language.forms import (
    DEFAULT_CLASSES,
    Application,
    Constant,
    canonical_text,
    depth,
    read_form,
    to_corpus,
)
from annotations.language.world import (
    ArgumentKind,
    Predicate,
    PredicateKind,
    Signature,
    check_form,
    infer_signatures,
    known_kinds,
)
from parser_service.neural.t5.automaton import START, Automaton
from parser_service.neural.t5.rules import Rules, length
from parser_service.neural.t5.spelling import read, spell
from tests.parser_service.neural.conftest import toy_pairs

KINDS = st.sampled_from(known_kinds(DEFAULT_CLASSES))
SIGNATURES = st.dictionaries(
    st.sampled_from(["go", "and", "left_of", "L1", "e"]),
    st.lists(st.lists(KINDS, max_size=3).map(tuple), min_size=1, max_size=3, unique=True),
    max_size=4,
)
CONSTANTS = st.lists(
    st.sampled_from(["<room>", "<object>", "the é", "object0", 3, -12]), max_size=3, unique=True
)


def rules_of(texts, declared=None):
    return Rules.of([read_form(text) for text in texts], declared)


def declare(signatures):
    return {
        name: Predicate(name, PredicateKind.ACTION, tuple(map(Signature, overloads)))
        for name, overloads in signatures.items()
    }


def walk(automaton, choose):
    """The atoms of a form that is written by choosing among those that are allowed."""
    state, atoms = START, []
    while True:
        allowed = automaton.continuations(state)
        if automaton.can_end(state):
            allowed = [*allowed, ""]
        assert allowed, f"nothing may follow {atoms}"
        atom = choose(sorted(allowed))
        if not atom:
            return atoms
        atoms.append(atom)
        state = automaton.follow(state, atom)


def assert_is_form(atoms, rules, predicates):
    """It passes the checker, is canonical, is spelled the one way there is, and is within the limits."""
    form = read(atoms)
    text = to_corpus(form)
    assert not check_form(form, predicates)
    assert read_form(text) == form and canonical_text(form) == text
    assert spell(form) == tuple(atoms)
    assert len(text.encode()) < rules.longest and depth(form) <= rules.deepest


@settings(max_examples=150, deadline=None)
@given(SIGNATURES, CONSTANTS, st.integers(1, 3), st.integers(1, 5), st.integers(8, 120), st.data())
def test_whatever_is_written_passes_the_checker(names, values, lambdas, deepest, longest, data):
    constants = tuple(map(Constant, values))
    signatures = {name: tuple(overloads) for name, overloads in names.items()}
    rules = Rules(signatures, constants, ("e", "t"), lambdas, deepest, longest + 1, False)
    atoms = walk(Automaton(rules), lambda allowed: data.draw(st.sampled_from(allowed)))
    assert_is_form(atoms, rules, declare(signatures))


def test_every_published_form_may_be_written(shared_data):
    content = (shared_data / "walker2019" / "para" / "train.txt").read_bytes()
    forms = sorted({record.form for record in read_pairs(content, "train").records}, key=str)
    automaton = Automaton(Rules.of(forms, None))
    for form in forms:
        state = START
        for atom in spell(form):
            assert atom in automaton.continuations(state)
            state = automaton.follow(state, atom)
        assert automaton.can_end(state) and state.spent == length(form)


def test_exactly_what_the_checker_passes_may_be_written():
    texts = {pair.form for pair in toy_pairs()} | {
        '( say " <name> " ( lambda $1 e ( here $1 ) ) )',
        '( bring ( lambda $1 e ( is_a $1 " <name> " ) ) " <room> " )',
    }
    rules = rules_of(texts)
    automaton, predicates = Automaton(rules), infer_signatures(map(read_form, texts))
    spelled = [spell(read_form(text)) for text in texts]
    atoms = sorted({atom for each in spelled for atom in each})
    changed = {
        (*each[:place], *instead, *each[place + left_out :])
        for each in spelled
        for place, left_out in product(range(len(each) + 1), (0, 1))
        for instead in ((), *((atom,) for atom in atoms))
    }
    right = 0
    for each in changed:
        is_written = automaton.accepts(each)
        assert is_written == is_right(each, predicates, rules), each
        right += is_written
    assert len(texts) + 5 < right < len(changed) / 4


def is_right(atoms, predicates, rules):
    """Whether atoms are the spelling of a canonical form that passes the checker."""
    try:
        form = read_form(to_corpus(read(atoms)))
    except ValueError:  # LanguageError is one
        return False
    bodies = all(
        isinstance(body, Application) or hasattr(body, "bodies") for body in of_lambdas(form)
    )
    return (
        bodies
        and spell(form) == atoms
        and canonical_text(form) == to_corpus(form)
        and not check_form(form, predicates)
        and depth(form) <= rules.deepest
        and length(form) <= rules.longest
    )


def of_lambdas(form):
    for part in getattr(form, "bodies", ()):
        yield part
    for part in (*getattr(form, "bodies", ()), *getattr(form, "arguments", ())):
        yield from of_lambdas(part)


def test_strict_knows_what_training_shows_and_domain_what_is_declared():
    texts = ['( go " <room> " )']
    declared = declare({"go": [("room",)], "greet": [("name",)]})
    greeting = spell(read_form('( greet " <name> " )'))
    strict, domain = Automaton(rules_of(texts)), Automaton(rules_of(texts, declared))
    assert domain.accepts(greeting) and not strict.accepts(greeting)
    assert not {"greet:", ":<name>"} & set(strict.atoms)
    assert rules_of(texts, {}) == rules_of(texts)


def test_without_a_predicate_that_can_be_written_the_answer_is_unknown():
    impossible = Rules({"do": ((ArgumentKind.NUMBER,),)}, (), ("e",), 1, 3, 100, False)
    automaton = Automaton(impossible)
    assert automaton.continuations(START) == ["?"]
    state = automaton.follow(START, "?")
    assert automaton.can_end(state) and not automaton.continuations(state)


@pytest.mark.parametrize("texts", [["UNKNOWN"], ["UNKNOWN", '( go " <room> " )'], []])
def test_unknown_may_be_written_where_training_has_it(texts):
    assert ("?" in Automaton(rules_of(texts)).continuations(START)) == (
        "UNKNOWN" in texts or not texts
    )


def test_rules_survive_json():
    rules = rules_of(pair.form for pair in toy_pairs())
    assert Rules.read(json.loads(json.dumps(rules.to_json()))) == rules
