"""The starter world is whole, without a fault, and shows everything that the language can do."""

from __future__ import annotations

import re

import pytest

from annotations.language.forms import DEFAULT_CLASSES, Choice, Symbols, read_form
from annotations.language.forms.symbols import ALIASES
from annotations.language.templates import GeneratorFolder, read_generator_folder, set_problems
from annotations.language.world import check_form, gloss, infer_signatures
from tests.annotations.language.ontology_files import read_ontology_folder
from tests.annotations.language.published import SHARED, needs_corpus
from tests.annotations.starter import (
    STARTER,
    categories,
    folder,
    generated,
    ontology,
    predicates,
    productions,
    wildcards,
)

# The one task that nobody has annotated; the README of the starter world names it.
UNANNOTATED = {
    "air the <room>",
    "sweep the <room>",
    "vacuum the <room>",
    "water the flowers at the <location>",
}


def form_texts() -> set[str]:
    return {expansion.form_text for expansion in generated().expansions}


def test_the_grammar_and_the_ontology_read_without_a_problem():
    assert folder().problems == ()
    assert read_ontology_folder(STARTER)[1] == ()


def test_no_template_has_a_problem_or_conflicts_with_another():
    assert set_problems(categories(), generated(), predicates()) == ()
    assert generated().conflicts == ()
    assert generated().unmatched == ()
    assert generated().outside_grammar == ()


def test_three_task_categories_each_bring_commands_of_their_own():
    assert [category.name for category in categories()] == ["1", "2", "3"]
    first = {expansion.task_category for expansion in generated().expansions}
    assert first == {"1", "2", "3"}


def test_every_command_has_a_template_but_those_of_one_task():
    annotated = {expansion.command for expansion in generated().expansions}
    said = {command for each in categories() for command in each.grammar.commands(limit=2000)}
    assert said - annotated == UNANNOTATED


def test_the_world_is_as_large_as_its_readme_says():
    readme = (STARTER / "README.md").read_text(encoding="utf-8")
    templates = sum(map(len, folder().templates.values()))
    records = (STARTER / "paraphrases.txt").read_text(encoding="utf-8").count("\n") // 3
    for figure in (
        f"| {len(productions())} |",
        f"= {templates} |",
        f"`predicates.json` | {len(predicates())} |",
        f"| {len(generated().expansions)} |",
        f"| {len(form_texts())} |",
        f"`paraphrases.txt` | {records} |",
        f"`objects.xml`, `categories.txt` | {len(ontology().of_class('object'))} |",
        f"`locations.xml` | {len(ontology().of_class('location'))} |",
    ):
        assert figure in readme


def test_it_is_large_enough_to_learn_from():
    assert len(productions()) >= 60
    assert sum(map(len, folder().templates.values())) >= 45
    assert len(predicates()) >= 25
    assert len(generated().expansions) >= 350
    assert len(form_texts()) >= 45


def test_every_kind_of_wildcard_occurs():
    kinds = {wildcard.kind for wildcard in wildcards()}
    assert kinds == {*DEFAULT_CLASSES.tokens, "void", "pron"} - {"room"}
    assert {wildcard.name for wildcard in wildcards()} >= set(ALIASES)


@pytest.mark.parametrize(
    "has",
    [
        lambda wildcard: wildcard.obfuscated,
        lambda wildcard: wildcard.id == 2,
        lambda wildcard: wildcard.where is not None,
        lambda wildcard: wildcard.kind == "void" and wildcard.meta,
        lambda wildcard: wildcard.kind != "void" and wildcard.meta,
    ],
    ids=["obfuscated", "id", "where", "void with a note", "other with a note"],
)
def test_wildcards_use_everything_they_may_have(has):
    assert any(has(wildcard) for wildcard in wildcards())


def test_choices_nest():
    choices = [s for each in productions() for s in each.expansion if isinstance(s, Choice)]
    inner = [s for each in choices for alternative in each.alternatives for s in alternative]
    assert any(isinstance(symbol, Choice) for symbol in inner)


@pytest.mark.parametrize(
    "piece",
    [
        "( sequence ( go ",
        "( largest $1 ) ( is_a $1 ",
        "( smallest $1 3 ) ",
        "( left_of $1 ( lambda $2 e ",
        '( answer " <question> " ',
        "( say ( count ",
        "( bring UNKNOWN )",
        "( lambda $1 e ( lambda $2 e ( person $2 ) ( name $2 $1 ) ",
    ],
)
def test_forms_show_each_construction(piece):
    assert any(piece in text for text in form_texts())


def test_a_whole_form_may_be_unknown():
    assert "UNKNOWN" in form_texts()


def test_the_predicates_declared_are_those_of_the_forms_with_the_same_signatures():
    inferred = infer_signatures(map(read_form, form_texts()))
    assert set(inferred) == set(predicates())
    for name, declared in predicates().items():
        assert set(declared.signatures) == set(inferred[name].signatures), name
        assert declared.kind == inferred[name].kind, name


def test_every_form_fits_the_predicates_and_has_a_gloss_of_its_own():
    glosses: dict[str, str] = {}
    for text in form_texts():
        form = read_form(text)
        assert check_form(form, predicates()) == []
        assert glosses.setdefault(gloss(form, predicates()), text) == text


def test_glosses_are_english_without_traces_of_their_patterns():
    said = {gloss(read_form(text), predicates()) for text in form_texts()}
    assert "bring me something" in said
    assert not [each for each in said if re.search(r"[{}|_$]", each)]


@needs_corpus
def test_nothing_is_taken_from_the_published_generators_or_their_commands():
    published = SHARED / "walker2019"
    lines = [each.read_text("utf-8").splitlines() for each in published.glob("gen*/*.txt")]
    said = {command.lower() for each in lines for command in each[::2]}
    assert not {each.command.lower() for each in generated().expansions} & said
    theirs = [read_generator_folder(SHARED / f"generator-{year}") for year in (2018, 2019)]
    assert not sequences(folder()) & {each for other in theirs for each in sequences(other)}


def sequences(of: GeneratorFolder) -> set[Symbols]:
    """Expansions and patterns that say something: not a lone nonterminal, wildcard or word."""
    rules = [each.expansion for file in of.grammars.files.values() for each in file.productions]
    patterns = [each.pattern for file in of.templates.values() for each in file]
    return {each for each in (*rules, *patterns) if len(each) > 1}
