from parser_service.parsers.geca import geca
from parser_service.parsers.interface import Pair
from tests.parser_service.parsers.new_forms.conftest import (
    OBJECT,
    PLACE,
    ROOM,
    WAVING,
    bring,
    find,
)


def test_what_two_commands_show_is_exchanged_in_a_third(pairs):
    [made] = geca(pairs)
    assert made.form == find(OBJECT, PLACE)
    assert made.commands == ("please find the <object> at the <location>",)
    assert made.origin == find(OBJECT, ROOM)
    assert made.change == "at:$1:<room> → at:$1:<location>"


def test_without_three_shared_words_nothing_is_learned(pairs):
    short = [Pair(pair.utterance.replace("bring me the", ""), pair.form) for pair in pairs[:2]]
    assert geca([*short, pairs[2]]) == []


def test_forms_that_differ_in_two_things_teach_nothing(pairs):
    other = Pair("bring me the person at the <location> now", bring(WAVING, PLACE))
    assert geca([pairs[0], other, pairs[2]]) == []


def test_rules_come_from_generated_pairs_where_there_are_any(pairs):
    spoken = [Pair(pair.utterance, pair.form, "paraphrased") for pair in pairs]
    assert geca(spoken)
    assert geca([*spoken[:2], pairs[2]]) == []


def test_a_command_that_would_mean_two_things_is_dropped(pairs):
    other = [
        Pair("bring me the <object> from the <room> soon", bring(OBJECT, ROOM)),
        Pair("bring me the <object> at the <location> soon", bring(OBJECT, WAVING)),
    ]
    assert find(OBJECT, WAVING) not in {made.form for made in geca([*pairs, *other])}
    assert find(OBJECT, PLACE) not in {made.form for made in geca([*pairs, *other])}


def test_a_known_form_is_not_made_again(pairs):
    known = Pair("seek the <object>", find(OBJECT, PLACE))
    assert geca([*pairs, known]) == []


def test_a_text_that_is_no_form_is_left_out(pairs):
    assert len(geca([*pairs, Pair("bring me the <object> or so", "( bring")])) == 1


def test_the_order_of_the_pairs_changes_nothing(pairs):
    assert geca(pairs) == geca(pairs[::-1])
