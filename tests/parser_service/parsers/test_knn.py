import pytest

from annotations.language.texts.errors import Refusal
from parser_service.parsers.interface import Cancelled, Candidate, Pair
from parser_service.parsers.knn import NearestNeighbour, NearestNeighbourConfig
from tests.parser_service.parsers.pair_files import read_pairs

GO, FIND, BRING = '( go " <room> " )', '( find " <object> " )', '( bring " <object> " )'
TRAIN = [
    Pair("go to the kitchen", GO),
    Pair("find the cup", FIND),
    Pair("find me a cup", FIND),
    Pair("bring me the cup", BRING),
]


@pytest.fixture
def parser():
    parser = NearestNeighbour()
    parser.fit(TRAIN)
    return parser


def answer(parser, utterance):
    return parser.predict([utterance])[0][0].form


def test_the_utterance_that_shares_most_words_wins(parser):
    assert answer(parser, "Go to the bedroom!") == GO
    assert parser.predict(["find the cup"]) == [[Candidate(FIND, 1.0)]]


def test_the_score_is_the_share_of_common_words(parser):
    [[best]] = parser.predict(["go to kitchen now"])  # 3 of 5 different words
    assert best == Candidate(GO, 3 / 5)


def test_a_word_said_twice_counts_once(parser):
    assert parser.predict(["find find the the cup"])[0][0].score == 1.0


def test_candidates_are_distinct_forms_nearest_first(parser):
    [ranked] = parser.predict(["find a cup"], beam_width=5)
    assert [candidate.form for candidate in ranked] == [FIND, BRING, GO]
    assert sorted((c.score for c in ranked), reverse=True) == [c.score for c in ranked]


def test_of_equally_near_utterances_the_form_that_most_carry_wins():
    parser = NearestNeighbour()
    parser.fit([Pair("take a", "A"), Pair("take b", "B"), Pair("take c", "B")])
    assert answer(parser, "take") == "B"


def test_a_tie_in_votes_too_goes_to_the_first_form_of_the_alphabet_in_any_order():
    pairs = [Pair("take b", "B"), Pair("take a", "A")]
    for train in (pairs, pairs[::-1]):
        parser = NearestNeighbour()
        parser.fit(train)
        assert answer(parser, "take") == "A"


def test_validation_pairs_are_neighbours_for_the_test_part_only(parser):
    follow = Pair("follow Anna", '( follow " <name> " )')
    parser.fit(TRAIN, [follow])
    assert answer(parser, "follow Anna") != follow.form
    assert answer(parser.for_test_part([follow]), "follow Anna") == follow.form
    assert answer(parser, "follow Anna") != follow.form


def test_a_form_that_no_neighbour_carries_is_never_answered(parser):
    ranked = parser.predict(["answer the question", "", "cup"], beam_width=10)
    assert {candidate.form for answers in ranked for candidate in answers} <= {GO, FIND, BRING}


def test_below_the_least_overlap_there_is_no_answer():
    parser = NearestNeighbour(NearestNeighbourConfig(least_overlap=0.9))
    parser.fit(TRAIN)
    assert parser.predict(["find the mug", "find the cup"]) == [[], [Candidate(FIND, 1.0)]]


def test_saved_and_loaded_it_answers_alike(parser, tmp_path):
    parser.save(tmp_path / "knn")
    loaded = NearestNeighbour.load(tmp_path / "knn")
    utterances = ["find it", "go", "nothing known", "bring a cup"]
    assert loaded.predict(utterances, 3) == parser.predict(utterances, 3)


def test_without_training_pairs_it_refuses():
    with pytest.raises(Refusal) as refused:
        NearestNeighbour().fit([])
    assert refused.value.code == "no_training_pairs"


def test_a_cancelled_prediction_stops(parser):
    def cancel():
        raise Cancelled

    with pytest.raises(Cancelled):
        parser.predict(["go"], check=cancel)


@pytest.mark.parametrize(
    ("train", "test", "at_least"),
    [
        (["gen"], "gen", 0.63),
        (["gen"], "para", 0.40),
        (["para"], "para", 0.42),
        (["gen", "para"], "para", 0.49),
    ],
)
def test_on_the_published_pairs_it_is_as_good_as_published(shared_data, train, test, at_least):
    parser = NearestNeighbour()
    parser.fit([pair for name in train for pair in published(shared_data, name, "train")])
    held_out = published(shared_data, test, "val")
    answers = parser.predict([pair.utterance for pair in held_out])
    right = sum(a[0].form == p.form for a, p in zip(answers, held_out, strict=True))
    assert right / len(held_out) >= at_least


def test_on_the_published_split_by_form_it_is_never_right(shared_data):
    parser = NearestNeighbour()
    parser.fit(published(shared_data, "para_logical", "train"))
    held_out = published(shared_data, "para_logical", "val")
    answers = parser.predict([pair.utterance for pair in held_out])
    assert not any(a[0].form == p.form for a, p in zip(answers, held_out, strict=True))


def published(shared_data, name, part):
    return read_pairs(shared_data / "walker2019" / name / f"{part}.txt")


def test_an_answer_tells_its_neighbours_and_where_its_form_is_from(parser):
    [[best, *_]] = parser.predict(["find the cup"], 2)
    assert best.origin == "training"
    assert best.parts == {"similarity": 1.0, "neighbours": 1}
    [[best]] = parser.for_test_part([Pair("stop it", "( stop )")]).predict(["stop it"])
    assert (best.form, best.origin) == ("( stop )", "validation")
    [[best]] = parser.for_test_part([Pair("find the cup", FIND)]).predict(["find the cup"])
    assert (best.origin, best.parts["neighbours"]) == ("training", 2)
