"""Answers of parsers that did not see the pair."""

from __future__ import annotations

import pytest

from annotations.background.progress import Unwatched
from annotations.language.corpus.label_errors import LabelledPair
from annotations.language.texts.errors import Refusal
from parser_service.labelling.out_of_fold import AUDITORS, answer_out_of_fold
from parser_service.parsers.interface import Cancelled, Pair

FIND, GO = '( find " <object> " )', '( go " <room> " )'
PAIRS = [
    LabelledPair(f"{verb}-{number}", f"{verb} it {number}", form, f"{verb} command {number}")
    for verb, form in (("find", FIND), ("go", GO))
    for number in range(6)
]


def test_only_parsers_that_learn_from_pairs_without_torch_audit():
    assert AUDITORS == ("knn", "linear")


def test_every_pair_is_answered_for():
    answers = answer_out_of_fold(PAIRS, folds=3)
    assert set(answers) == {pair.key for pair in PAIRS}
    assert all(answers[pair.key][0].form == pair.form for pair in PAIRS)


def test_nothing_of_the_source_command_of_a_pair_is_seen():
    """Form and words of each source command are its own, so what answers with them has seen them."""
    pairs = [
        LabelledPair(f"{number}-{copy}", f"word{number}", f"( do{number} )", f"word{number} now")
        for number in range(6)
        for copy in range(2)
    ]
    commands = [Pair(pair.source_command, pair.form) for pair in pairs]
    answers = answer_out_of_fold(pairs, folds=6, commands=commands)
    for pair in pairs:
        assert pair.form not in {answer.form for answer in answers[pair.key]}


def test_commands_that_no_held_out_pair_rewrites_are_seen():
    other = Pair("fetch it 0", "( fetch )")
    answers = answer_out_of_fold(
        [*PAIRS, LabelledPair("x", "please fetch it 0", GO)], folds=3, commands=[other]
    )
    assert answers["x"][0].form == "( fetch )"


def test_it_stops_when_it_has_to():
    calls = []

    class Stopping(Unwatched):
        def check(self):
            calls.append(1)
            if len(calls) > 3:
                raise Cancelled

    with pytest.raises(Cancelled):
        answer_out_of_fold(PAIRS, folds=3, progress=Stopping())
    assert len(calls) == 4


def test_a_parser_that_needs_torch_is_refused():
    with pytest.raises(Refusal) as refused:
        answer_out_of_fold(PAIRS, "seq2seq")
    assert refused.value.code == "parser_cannot_audit"
