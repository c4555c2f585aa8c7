"""The form of a command is said with the slots of the pattern that makes it."""

from __future__ import annotations

import pytest

from annotations.language.forms import canonical_text, read_form, to_template
from annotations.language.templates import (
    TemplateExpander,
    lift_forms,
    make_template,
    read_generator_folder,
)
from tests.annotations.language.templates.test_suggester import GRAMMAR


def lifted(form: str, pattern: str) -> list[str]:
    symbols = make_template(pattern, "UNKNOWN").pattern
    return [to_template(each) for each in lift_forms(read_form(form), symbols, GRAMMAR)]


@pytest.mark.parametrize(
    ("form", "pattern", "expected"),
    [
        ('( go " <room> " )', "go to the {room}", ["(go {room})"]),
        ("( sing )", "go to the {room}", ["(sing)"]),
        ('( go " <room> " )', "go home", []),
        (
            '( put " <location> " " <location> " )',
            "put {placement 1} on {placement 2}",
            ["(put {placement 1} {placement 2})", "(put {placement 2} {placement 1})"],
        ),
        ('( say " give " )', "say $bring", ["(say $bring)"]),
        ('( say " take " )', "say $bring", ['(say "take")']),
    ],
)
def test_slots_stand_where_the_command_has_their_values(form, pattern, expected):
    assert lifted(form, pattern) == expected


def test_the_form_of_a_first_command_is_that_of_its_template(shared_data):
    """All but the 8 published templates in which a nonterminal is a predicate."""
    folder = read_generator_folder(shared_data / "generator-2018")
    templates = {
        template.position: (category.grammar, template)
        for category in folder.categories()
        for template in category.templates
    }
    right = 0
    for grammar, template in templates.values():
        _, form = next(TemplateExpander(grammar).pairs(template))
        forms = lift_forms(read_form(form), template.pattern, grammar)
        right += canonical_text(template.form) in map(canonical_text, forms)
    assert (right, len(templates)) == (117, 125)
