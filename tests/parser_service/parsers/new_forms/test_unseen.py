from annotations.language.forms import read_form
from annotations.language.world import (
    ArgumentKind,
    Predicate,
    PredicateKind,
    Signature,
    check_form,
    infer_signatures,
)
from parser_service.parsers.pool import SURE
from parser_service.parsers.unseen import unseen
from tests.parser_service.parsers.new_forms.conftest import NAMED, OBJECT, ROOM, bring, find

LAMBDA, LOCATION, VARIABLE = ArgumentKind.LAMBDA, "location", ArgumentKind.VARIABLE


def declared(name, *signatures, kind=PredicateKind.ACTION):
    return Predicate(name, kind, tuple(map(Signature, signatures)))


def made(predicate, *forms):
    known = infer_signatures(map(read_form, forms))
    return {each.form for each in unseen(forms, {**known, predicate.name: predicate})}


def put(*descriptions):
    return find(*descriptions).replace("( find", "( put", 1)[:-2] + ' " <location> " )'


def test_an_action_is_done_with_what_others_are_done_with():
    assert made(declared("put", (LAMBDA, LOCATION)), bring(OBJECT, ROOM), find(NAMED)) == {
        put(OBJECT, ROOM),
        put(NAMED),
    }


def test_a_later_thing_may_be_left_away():
    giving = (
        '( bring ( lambda $1 e ( is_a $1 " <object> " ) ) ( lambda $1 e ( name $1 " <name> " ) ) )'
    )
    assert made(declared("put", (LAMBDA, LOCATION)), giving) == {put(OBJECT)}
    assert made(declared("go", (LOCATION,)), giving) == {'( go " <location> " )'}
    assert made(declared("pour", (LAMBDA, LAMBDA)), giving) == {giving.replace("bring", "pour")}
    assert made(declared("wait", ()), giving) == {"( wait )"}


def test_an_action_of_a_sequence_is_another_one():
    both = f"( sequence {find(NAMED)} {find(OBJECT)} )"
    made_of_both = made(declared("follow", (LAMBDA,)), both)
    assert f"( sequence {find(NAMED).replace('find', 'follow')} {find(OBJECT)} )" in made_of_both


def test_a_description_stands_where_another_stands_alone():
    leftmost = declared("leftmost", (VARIABLE, LOCATION), kind=PredicateKind.DESCRIPTION)
    new_forms = made(leftmost, bring(OBJECT), find(OBJECT, ROOM))
    assert new_forms == {bring('leftmost $1 " <location> "')}


def test_a_relation_stands_between_the_same_two():
    alone = "( find ( lambda $1 e ( lambda $2 e ( above $2 $1 ) ) ) )"
    beside = declared("beside", (VARIABLE, VARIABLE), kind=PredicateKind.DESCRIPTION)
    assert made(beside, bring(OBJECT), alone) == {alone.replace("above", "beside")}


def test_a_signature_that_training_never_shows_is_taken_up():
    bringing = declared("bring", (LAMBDA,), (LAMBDA, LOCATION))
    assert made(bringing, bring(OBJECT)) == {f'{bring(OBJECT)[:-2]} " <location> " )'}
    both = bring(OBJECT), f'{bring(OBJECT)[:-2]} " <location> " )'
    assert made(bringing, *both) == set()


def test_what_training_shows_and_what_has_no_constant_is_left_alone():
    assert made(declared("bring", (LAMBDA,)), bring(OBJECT)) == set()
    assert made(declared("count", (LAMBDA, ArgumentKind.NUMBER)), bring(OBJECT)) == set()


def test_a_text_that_is_no_form_is_left_out():
    assert unseen(["( bring"], {"go": declared("go", (LOCATION,))}) == []


def test_each_way_is_sure_well_typed_and_says_what_it_changed():
    predicate = declared("put", (LAMBDA, LOCATION))
    known = {**infer_signatures([read_form(find(OBJECT))]), "put": predicate}
    [way] = unseen([find(OBJECT)], known)
    assert (way.step, way.origin, way.weight) == ("unseen", find(OBJECT), SURE)
    assert way.change == f"{find(OBJECT)} → {put(OBJECT)}"
    assert check_form(read_form(way.form), known) == []
