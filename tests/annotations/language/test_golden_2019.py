"""The 2019 generator: every production is read, and its size is known at once."""

from itertools import islice

import pytest

from annotations.language.grammar import Recognizer, read_productions
from annotations.language.grammar.productions import print_production
from annotations.language.templates import read_generator_folder
from annotations.language.texts.errors import LanguageError


@pytest.fixture(scope="module")
def folder(shared_data):
    return read_generator_folder(shared_data / "generator-2019")


@pytest.fixture(scope="module")
def grammars(folder):
    return {category.name: category.grammar for category in folder.categories()}


def test_production_lines(folder):
    counts = {name: len(file.productions) for name, file in folder.grammars.files.items()}
    assert counts == {"common_rules.txt": 62, "gpsr.txt": 73, "egpsr.txt": 198}


def test_every_production_survives_printing_and_reading(folder):
    for file in folder.grammars.files.values():
        text = "\n".join(map(print_production, file.productions))
        assert read_productions(text).productions == file.productions


def places(folder, words):
    return [str(problem.position) for problem in folder.problems if words in problem.message]


def test_lines_that_repeat_one_another_are_warnings(folder):
    assert places(folder, "ambiguous") == [
        "egpsr.txt:37:1",
        "egpsr.txt:128:1",
        "egpsr.txt:336:1",
        "gpsr.txt:46:1",
    ]


def test_problems_are_warnings_about_what_is_never_used(folder):
    assert places(folder, "never reaches") == [
        "common_rules.txt:60:1",
        "common_rules.txt:106:1",
        "common_rules.txt:140:1",
        "egpsr.txt:327:1",
        "egpsr.txt:328:1",
        "egpsr.txt:329:1",
        "egpsr.txt:330:1",
        "gpsr.txt:156:1",
    ]
    assert not folder.has_errors


def test_gpsr_expands_to_the_commands_of_the_published_reader(grammars):
    commands = list(grammars["gpsr"].commands())
    assert len(commands) == len(set(commands)) == 14_520
    recognizer = Recognizer(grammars["gpsr"])
    assert all(map(recognizer.accepts, commands[::50]))


def test_egpsr_answers_at_once_with_its_size_and_refuses_enumeration_above_a_limit(grammars):
    assert grammars["egpsr"].size() == 931_452
    assert len(list(islice(grammars["egpsr"].commands(), 100))) == 100
    with pytest.raises(LanguageError, match="931,452"):
        grammars["egpsr"].commands(limit=100_000)


def test_the_note_with_lone_parentheses_and_the_condition_without_and_are_read(folder):
    productions = folder.grammars.files["egpsr.txt"].productions
    (cereal,) = (each for each in productions if each.nonterminal == "cereal")
    assert cereal.expansion[0].where.operator == "and"
    notes = [
        symbol.value
        for each in productions
        if each.nonterminal == "gbriefing"
        for symbol in each.expansion[0].meta
        if hasattr(symbol, "value")
    ]
    assert notes.count(")") == 3
