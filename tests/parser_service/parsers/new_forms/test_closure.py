import pytest

from annotations.language.forms import read_form
from annotations.language.world import check_form, infer_signatures
from parser_service.parsers.closure import CHANGES, close
from tests.parser_service.parsers.new_forms.conftest import (
    NAMED,
    OBJECT,
    PLACE,
    ROOM,
    WAVING,
    bring,
    find,
)


def forms_by(kind, *forms):
    predicates = infer_signatures(map(read_form, forms))
    return {made.form for made in close(forms, predicates, {kind: CHANGES[kind]})} - set(forms)


def test_a_description_is_exchanged_for_one_seen_beside_the_others():
    assert forms_by("exchange", find(NAMED, ROOM), find(WAVING, ROOM), find(OBJECT, PLACE)) >= {
        find(NAMED, PLACE),
        find(WAVING, PLACE),
    }
    assert find(NAMED, WAVING) not in forms_by("exchange", find(NAMED, ROOM), find(WAVING, ROOM))


def test_a_description_is_dropped_but_never_the_last():
    assert forms_by("drop", find(OBJECT, ROOM)) == {find(OBJECT), find(ROOM)}
    assert forms_by("drop", find(OBJECT)) == set()


def test_a_description_is_added_where_it_has_stood():
    assert forms_by("add", find(OBJECT, ROOM), bring(OBJECT)) == {bring(OBJECT, ROOM)}


def test_what_one_action_takes_is_given_to_another_that_takes_such_things():
    made = forms_by("transplant", find(OBJECT, ROOM), bring(OBJECT), bring(ROOM), find(NAMED))
    assert bring(OBJECT, ROOM) in made
    assert bring(NAMED) not in made


def test_arguments_change_as_the_signatures_allow():
    made = forms_by(
        "retype", find(OBJECT, ROOM), bring(PLACE), f'{bring(OBJECT)[:-2]} " <room> " )'
    )
    assert find(OBJECT, PLACE) in made and bring(ROOM) in made
    assert bring(OBJECT) in made
    assert f'{bring(PLACE)[:-2]} " <room> " )' in made


def test_a_conjunction_written_out_changes_like_any_other():
    written = '( say ( lambda $1 e ( and ( biggest $1 ) ( at $1 " <room> " ) ) ) )'
    assert forms_by("drop", written) >= {written.replace("( biggest $1 ) ", "")}


def test_every_way_to_a_form_is_kept_with_its_origin():
    forms = [find(NAMED, ROOM), find(WAVING, ROOM), find(OBJECT, PLACE)]
    ways = [
        made
        for made in close(forms, infer_signatures(map(read_form, forms)))
        if made.form == find(NAMED, PLACE)
    ]
    assert {way.step for way in ways} == {"exchange", "retype"}
    assert all(way.origin in forms and "→" in way.change for way in ways)


def test_nothing_unbound_or_against_the_signatures_is_made():
    nested = '( say ( lambda $1 e ( lambda $2 e ( name $2 $1 ) ( at $2 " <room> " ) ) ) )'
    forms = [nested, find(OBJECT, ROOM), find(NAMED), bring(OBJECT)]
    predicates = infer_signatures(map(read_form, forms))
    for made in close(forms, predicates):
        assert check_form(read_form(made.form), predicates) == []


def test_a_text_that_is_no_form_is_left_out():
    assert close(["( bring"], {}) == []


@pytest.mark.parametrize("kind", CHANGES)
def test_no_change_gives_the_form_itself(kind):
    assert find(OBJECT, ROOM) not in {
        made.form for made in close([find(OBJECT, ROOM)], {}, {kind: CHANGES[kind]})
    }
