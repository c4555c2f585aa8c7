"""A form moves to another pattern with the slots of that one."""

from __future__ import annotations

import pytest

from annotations.language.forms import to_template
from annotations.language.grammar import Grammar, read_productions
from annotations.language.templates import make_template, read_template, transfer_form

GRAMMAR = Grammar(read_productions("$Main = find the $object\n$object = {aobject}").productions)


@pytest.mark.parametrize(
    ("line", "target", "moved"),
    [
        ("find the {aobject?} = (find {aobject?})", "look for the {kobject?}", "(find {kobject?})"),
        ("find the {aobject} = (find {aobject})", "find the $object", "(find $object)"),
        (
            "take {object 1} to {beacon 1} = (put {object 1} {beacon 1})",
            "bring {object} to {beacon 2}",
            "(put {object} {beacon 2})",
        ),
        ("find the {aobject} = UNKNOWN", "sing", "UNKNOWN"),
    ],
)
def test_slots_in_the_same_places_are_exchanged(line, target, moved):
    template = read_template(line)
    pattern = make_template(target, "UNKNOWN").pattern
    form = transfer_form(template.form, template.pattern, pattern, GRAMMAR)
    assert to_template(form) == moved


def test_a_slot_without_a_counterpart_has_nowhere_to_go():
    template = read_template("go to {room} = (go {room})")
    pattern = make_template("go home", "UNKNOWN").pattern
    assert transfer_form(template.form, template.pattern, pattern, GRAMMAR) is None
