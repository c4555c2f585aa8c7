"""What the checker says of a template, whether its commands are expanded for it or kept from before."""

from __future__ import annotations

from dataclasses import replace

import pytest

from annotations.language.forms import read_form
from annotations.language.grammar import Budget, Grammar, read_productions
from annotations.language.templates import GrammarExpansions, read_template, template_checker
from annotations.language.world import infer_signatures


@pytest.mark.parametrize(
    "line",
    [
        "$find the {kobject} = (find (λ$1:e (is_a $1 {kobject})))",
        "$find the {kobject} = (fnd (λ$1:e (is_a $1 {kobject})))",
        "(find | spot) the {kobject} = (find {kobject})",
        'sing = (go "home")',
        '$gone = (go "home")',
    ],
)
def test_what_was_expanded_before_is_checked_alike(line):
    grammar = Grammar(
        read_productions("$Main = $find the {kobject}\n$find = find | look for").productions
    )
    template, declared = (
        read_template(line),
        infer_signatures([read_form('(find (is_a "<object>"))')]),
    )
    fresh = template_checker(grammar, declared)
    kept = GrammarExpansions(grammar, most_kept=100)
    kept.pairs(template, Budget())
    assert kept.has(template)
    again = replace(fresh, recognizer=kept)
    assert again.problems(template) == fresh.problems(template)
