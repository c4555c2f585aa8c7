from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from safetensors.numpy import load_file, save_file

from annotations.language.texts.errors import Refusal
from annotations.language.world import Entity, Ontology
from parser_service.parsers import linear
from parser_service.parsers.hyperparameters.linear import LinearConfig
from parser_service.parsers.interface import Cancelled, Knowledge, Observer, Pair
from parser_service.parsers.linear import VOCABULARY, WEIGHTS, LinearClassifier
from parser_service.parsers.storage import CONFIG, file_hash
from tests.parser_service.made_up import made_up_pairs

TRAIN = [Pair(text, form) for command, said, form in made_up_pairs() for text in (command, said)]
FORMS = {pair.form for pair in TRAIN}


def fitted(pairs=TRAIN, seed=0, **config):
    parser = LinearClassifier(LinearConfig(**config), seed)
    parser.fit(pairs)
    return parser


@pytest.fixture(scope="module")
def parser():
    return fitted()


def best(parser, text):
    return parser.predict([text])[0][0]


def test_it_answers_new_wording_of_known_forms(parser):
    answered = best(parser, "could you please fetch me the <object> which is in the <room>")
    assert (
        answered.form == '( bring ( lambda $1 e ( is_a $1 " <object> " ) ( at $1 " <room> " ) ) )'
    )
    assert answered.origin == "training"


def test_it_is_right_on_what_it_learned(parser):
    answers = parser.predict([pair.utterance for pair in TRAIN])
    assert [ranked[0].form for ranked in answers] == [pair.form for pair in TRAIN]


def test_candidates_are_distinct_forms_of_training_the_most_probable_first(parser):
    [ranked] = parser.predict(["where is the <object> now"], 5)
    scores = [each.score for each in ranked]
    assert len({each.form for each in ranked}) == len(ranked) == 5
    assert {each.form for each in ranked} <= FORMS
    assert scores == sorted(scores, reverse=True)
    assert all(each.score <= each.parts["alone"] for each in ranked)


@pytest.mark.parametrize("text", ["find the <object>", "", "qwzx", "!!!", "find " * 900])
def test_scores_are_probabilities_of_all_forms_and_of_none(parser, text):
    [ranked] = parser.predict([text], len(FORMS))
    assert len(ranked) == len(FORMS)
    assert all(0 <= each.score <= 1 for each in ranked)
    assert sum(each.score for each in ranked) <= 1 + 1e-9


def test_an_answer_does_not_depend_on_what_is_asked_beside_it(parser):
    texts = [pair.utterance for pair in TRAIN] * 2  # more than a batch
    together = parser.predict(texts, 3)
    assert together == [parser.predict([text], 3)[0] for text in texts]


def test_case_and_punctuation_say_nothing(parser):
    assert parser.predict(["Find, the <object>!"], 3) == parser.predict(["find the <object>"], 3)


def test_equal_pairs_and_seeds_give_equal_scores():
    assert fitted(seed=3).predict(["find it"], 5) == fitted(seed=3).predict(["find it"], 5)


ONTOLOGY = Ontology((Entity("object", "cup"), Entity("room", "den"), Entity("location", "desk")))


def test_where_the_ontology_is_known_classes_of_entities_count_as_words(tmp_path):
    parser = LinearClassifier(knowledge=Knowledge(ontology=ONTOLOGY))
    parser.fit(TRAIN)
    in_room = '( bring ( lambda $1 e ( is_a $1 " <object> " ) ( at $1 " <room> " ) ) )'
    at_place = '( bring ( lambda $1 e ( is_a $1 " <object> " ) ( at $1 " <location> " ) ) )'
    assert best(parser, "bring me the cup in the den").form == in_room
    assert best(parser, "bring me the cup near the desk").form == at_place
    parser.save(tmp_path)
    loaded = LinearClassifier.load(tmp_path, Knowledge(ontology=ONTOLOGY))
    texts = ["bring me the cup in the den", "the den", "qwzx"]
    assert loaded.predict(texts, 5) == parser.predict(texts, 5)
    with pytest.raises(Refusal) as refused:
        LinearClassifier.load(tmp_path)
    assert refused.value.code == "ontology_missing"


def test_what_was_trained_without_an_ontology_reads_none(parser, tmp_path):
    parser.save(tmp_path)
    loaded = LinearClassifier.load(tmp_path, Knowledge(ontology=ONTOLOGY))
    assert loaded.predict(["the cup in the den"], 5) == parser.predict(["the cup in the den"], 5)


def test_one_form_alone_is_answered():
    only = fitted([Pair("go home", "( go )"), Pair("leave", "( go )")])
    assert best(only, "go home").form == "( go )"
    assert len(only.predict(["anything"], 5)[0]) == 1


def test_no_pairs_and_pairs_without_words_are_refused():
    for pairs in ([], [Pair("!?", "( go )"), Pair("", "( stop )")]):
        with pytest.raises(Refusal) as refused:
            LinearClassifier().fit(pairs)
        assert refused.value.code == "no_training_pairs"


def test_a_parser_that_has_learned_nothing_says_so(tmp_path):
    with pytest.raises(ValueError):
        LinearClassifier().predict(["go"])
    with pytest.raises(ValueError):
        LinearClassifier().save(tmp_path / "model")
    assert not (tmp_path / "model").exists()


def test_improbable_answers_are_unknown_where_a_bound_is_set():
    careful = fitted(unknown_below=0.999)
    [ranked] = careful.predict(["qwzx"], 3)
    assert (ranked[0].form, ranked[0].score, ranked[0].origin) == ("UNKNOWN", 0.999, "refusal")
    assert len(ranked) == 3


def test_who_is_asked_by_people_refuses_what_has_no_known_word(parser):
    hesitant = parser.hesitant()
    assert best(hesitant, "qwzx").form == best(hesitant, "").form == "UNKNOWN"
    assert best(hesitant, "find qwzx") == best(parser, "find qwzx")
    assert best(parser, "qwzx").form != "UNKNOWN"


def test_unknown_is_a_form_like_others_where_pairs_say_so():
    parser = fitted([*TRAIN, Pair("sing a song", "UNKNOWN"), Pair("dance", "UNKNOWN")])
    assert best(parser, "sing a song").form == "UNKNOWN"
    [ranked] = parser.hesitant().predict(["qwzx"], 50)
    assert [each.form for each in ranked].count("UNKNOWN") == 1


def test_training_is_cancelled_between_forms():
    class Impatient(Observer):
        checks = 0

        def check(self):
            self.checks += 1
            if self.checks > 3:
                raise Cancelled

    observer = Impatient()
    with pytest.raises(Cancelled):
        LinearClassifier().fit(TRAIN, (), observer)
    assert observer.checks == 4


def test_answering_is_stopped_between_batches(parser):
    def stop():
        raise Cancelled

    with pytest.raises(Cancelled):
        parser.predict(["go"], 1, stop)


def test_training_tells_how_far_it_is():
    told = []

    class Listener(Observer):
        def progress(self, fraction, message=""):
            told.append(fraction)

    LinearClassifier().fit(TRAIN, (), Listener())
    assert told == sorted(told)
    assert told[-1] == 1


def test_of_too_many_pairs_each_form_has_its_share(monkeypatch):
    monkeypatch.setattr(linear, "MOST_PAIRS", 40)
    many = [Pair(f"find number {at}", "( find )") for at in range(200)]
    few = [Pair(f"{verb} it", f"( {verb} )", "paraphrased") for verb in ("bring", "take")]
    drawn = linear._draw([*many, *few], seed=1)
    assert len(drawn) == 40
    assert {pair.form for pair in drawn} == {"( find )", "( bring )", "( take )"}
    parser = LinearClassifier()
    parser.fit([*many, *few])
    assert best(parser, "bring it").form == "( bring )"


def test_of_many_pairs_a_form_is_told_from_the_most_similar(monkeypatch):
    monkeypatch.setattr(linear, "MOST_RIVALS", 1)
    monkeypatch.setattr(linear, "LEAST_RIVALS", 36)
    answers = fitted().predict([pair.utterance for pair in TRAIN])
    right = [ranked[0].form == pair.form for ranked, pair in zip(answers, TRAIN, strict=True)]
    assert np.mean(right) > 0.9


def test_features_are_the_most_frequent_where_there_are_too_many(monkeypatch):
    monkeypatch.setattr(linear, "MOST_WEIGHTS", 30 * len(FORMS))
    assert fitted().parameters() <= 31 * len(FORMS)


TEXTS = st.text(st.characters(exclude_categories=["Cs"]), max_size=30)


@settings(max_examples=25, deadline=None)
@given(
    st.lists(st.tuples(TEXTS, st.sampled_from("ABCD")), min_size=1, max_size=12),
    st.lists(TEXTS, max_size=5),
)
def test_a_saved_parser_gives_the_same_scores(tmp_path_factory, pairs, asked):
    parser = fitted([Pair("a word", "A"), *(Pair(*each) for each in pairs)])
    folder = tmp_path_factory.mktemp("saved")
    parser.save(folder)
    texts = [*asked, *(text for text, _ in pairs)]
    loaded = LinearClassifier.load(folder)
    assert loaded.predict(texts, 4) == parser.predict(texts, 4)
    assert loaded.hesitant().predict(texts, 4) == parser.hesitant().predict(texts, 4)
    assert loaded.parameters() == parser.parameters()


def test_saving_again_gives_the_same_bytes(parser, tmp_path):
    parser.save(tmp_path / "one")
    LinearClassifier.load(tmp_path / "one").save(tmp_path / "other")
    for name in (CONFIG, VOCABULARY, WEIGHTS):
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "other" / name).read_bytes()


def spoil_shape(folder):
    arrays = load_file(folder / WEIGHTS)
    save_file({**arrays, "weights": arrays["weights"][1:].copy()}, folder / WEIGHTS)


def spoil_bias(folder):
    arrays = load_file(folder / WEIGHTS)
    save_file({**arrays, "bias": arrays["bias"][:1].copy()}, folder / WEIGHTS)


def spoil_names(folder):
    save_file({"weights": np.zeros((1, 1), np.float32)}, folder / WEIGHTS)


def spoil_kind(folder):
    (folder / WEIGHTS).write_bytes(b"\x80\x04\x95")


def spoil_lists(folder):
    (folder / VOCABULARY).write_text("[1]")


def spoil_words(folder):
    lists = json.loads((folder / VOCABULARY).read_text())
    (folder / VOCABULARY).write_text(json.dumps({**lists, "words": lists["words"][1:]}))


@pytest.mark.parametrize(
    "spoil", [spoil_shape, spoil_bias, spoil_names, spoil_kind, spoil_lists, spoil_words]
)
def test_files_that_hold_something_else_are_refused(parser, tmp_path, spoil):
    parser.save(tmp_path)
    spoil(tmp_path)
    about = json.loads((tmp_path / CONFIG).read_text())
    about["sha256"] = {name: file_hash(tmp_path / name) for name in (VOCABULARY, WEIGHTS)}
    (tmp_path / CONFIG).write_text(json.dumps(about))
    with pytest.raises(Refusal) as refused:
        LinearClassifier.load(tmp_path)
    assert refused.value.code == "saved_parser_unreadable"
