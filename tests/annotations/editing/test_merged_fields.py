"""Two changes of one row become one, and what clashes is asked."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from annotations.editing.merged_fields import merge
from annotations.showing.form_presentation import compare

SIDES = st.fixed_dictionaries({name: st.sampled_from("abc") for name in ("pattern", "form")})


@given(SIDES, SIDES, SIDES)
def test_whoever_changed_a_field_has_it(base, theirs, mine):
    for field in merge(base, theirs, mine):
        name = field.name
        if mine[name] == base[name]:
            assert field.merged == theirs[name]
        if theirs[name] == base[name]:
            assert field.merged == mine[name]
        assert field.is_clash == (len({base[name], theirs[name], mine[name]}) == 3)


@given(SIDES, SIDES)
def test_without_a_base_every_difference_is_a_clash(theirs, mine):
    for field in merge(None, theirs, mine):
        assert field.is_clash == (not field.is_same)
        assert field.merged == field.mine


@given(st.text("ab c(", max_size=20), st.text("ab c(", max_size=20))
def test_a_comparison_loses_no_character(old, new):
    left, right = compare(old, new)
    assert "".join(text for _, text in left) == old
    assert "".join(text for _, text in right) == new
    same = [[text for change, text in side if change == "same"] for side in (left, right)]
    assert "".join(same[0]) == "".join(same[1])


def test_forms_are_compared_as_trees():
    left, right = compare("(go {room})", "(find {room})", is_form=True)
    assert [text for change, text in left if change == "changed"] == ["go"]
    assert [text for change, text in right if change == "changed"] == ["find"]
