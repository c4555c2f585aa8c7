from dataclasses import replace

import pytest
import torch

from annotations.language.texts.errors import Refusal
from parser_service.neural.seq2seq.epochs import Training
from parser_service.neural.seq2seq.seq2seq_parser import Seq2Seq
from parser_service.parsers.interface import Cancelled, Pair
from parser_service.parsers.storage import CONFIG, read_json, write_json
from tests.parser_service.neural.conftest import HELD_OUT, SMALL, Recorder
from tests.parser_service.neural.tampering import alter_weights, pickle_weights


def weights(parser):
    return {name: value.cpu() for name, value in parser._model.state_dict().items()}


def same_weights(one, other):
    return all(torch.equal(value, weights(other)[name]) for name, value in weights(one).items())


@pytest.fixture(scope="module")
def undisturbed(pairs):
    """A parser whose training nothing stopped."""
    parser = Seq2Seq(SMALL, seed=5)
    parser.fit(pairs[:18], pairs[18:22])
    return parser


def utterances(pairs):
    return [pair.utterance for pair in pairs]


def test_it_learns_a_toy_language(trained, pairs):
    answers = trained.predict(utterances(pairs))
    assert sum(a[0].form == p.form for a, p in zip(answers, pairs, strict=True)) >= 0.9 * len(pairs)


def test_it_reads_a_command_that_it_has_not_seen(trained, pairs):
    [unseen] = [pair for pair in pairs if pair.utterance == HELD_OUT]
    assert trained.predict([HELD_OUT])[0][0].form == unseen.form


def test_equal_seeds_give_equal_weights_whatever_else_draws_random_numbers(pairs):
    one, other = Seq2Seq(SMALL, seed=3), Seq2Seq(SMALL, seed=3)
    one.fit(pairs[:9], pairs[9:12])
    torch.rand(17)
    other.fit(pairs[:9], pairs[9:12])
    assert same_weights(one, other)


def test_training_leaves_the_global_random_state_and_the_threads_alone(pairs):
    before, threads = torch.get_rng_state(), torch.get_num_threads()
    Seq2Seq(SMALL, seed=3).fit(pairs[:9], pairs[9:12])
    assert torch.equal(before, torch.get_rng_state())
    assert torch.get_num_threads() == threads


def test_another_seed_gives_other_weights(pairs):
    one, other = Seq2Seq(SMALL, seed=3), Seq2Seq(SMALL, seed=4)
    assert not same_weights(one, other)


def test_fitting_twice_is_fitting_afresh(pairs):
    once, twice = Seq2Seq(SMALL, seed=3), Seq2Seq(SMALL, seed=3)
    once.fit(pairs[:9])
    twice.fit(pairs[9:])
    twice.fit(pairs[:9])
    assert same_weights(once, twice)


@pytest.mark.parametrize("checks", [1, 20, 70])
def test_a_stopped_run_goes_on_to_the_same_weights_and_predictions(
    undisturbed, pairs, tmp_path, checks
):
    with pytest.raises(Cancelled):
        stopped = Recorder(tmp_path / "run", stop_after_checks=checks)
        Seq2Seq(SMALL, seed=5).fit(pairs[:18], pairs[18:22], stopped)
    resumed, observe = Seq2Seq(SMALL, seed=5), Recorder(tmp_path / "run")
    resumed.fit(pairs[:18], pairs[18:22], observe)
    assert same_weights(undisturbed, resumed)
    asked = utterances(pairs)
    assert resumed.predict(asked, 3) == undisturbed.predict(asked, 3)
    epochs = [report.epoch for report in stopped.epochs + observe.epochs]
    assert epochs == list(range(1, SMALL.epochs + 1))


def test_a_run_resumed_twice_ends_alike(undisturbed, pairs, tmp_path):
    resumed = Seq2Seq(SMALL, seed=5)
    for checks in (50, 50):
        with pytest.raises(Cancelled):
            resumed.fit(pairs[:18], pairs[18:22], Recorder(tmp_path, stop_after_checks=checks))
    resumed.fit(pairs[:18], pairs[18:22], Recorder(tmp_path))
    assert same_weights(undisturbed, resumed)


def test_a_finished_run_that_is_resumed_learns_nothing_more(pairs, tmp_path):
    parser, observe = Seq2Seq(SMALL, seed=5), Recorder(tmp_path)
    parser.fit(pairs, pairs[:4], observe)
    again = Seq2Seq(SMALL, seed=5)
    again.fit(pairs, pairs[:4], observe)
    assert same_weights(parser, again)
    assert len(observe.epochs) == SMALL.epochs


def test_an_unreadable_checkpoint_is_said_and_training_starts_again(undisturbed, pairs, tmp_path):
    with pytest.raises(Cancelled):
        stopped = Recorder(tmp_path, stop_after_checks=50)
        Seq2Seq(SMALL, seed=5).fit(pairs[:18], pairs[18:22], stopped)
    (tmp_path / "last" / "training.safetensors").write_bytes(b"torn")
    resumed, observe = Seq2Seq(SMALL, seed=5), Recorder(tmp_path)
    resumed.fit(pairs[:18], pairs[18:22], observe)
    assert "training starts from the beginning" in observe.lines[0]
    assert same_weights(undisturbed, resumed)


def test_the_best_checkpoint_is_the_parser(pairs, tmp_path):
    parser, observe = Seq2Seq(SMALL, seed=5), Recorder(tmp_path)
    parser.fit(pairs[:18], pairs[18:22], observe)
    assert same_weights(parser, Seq2Seq.load(tmp_path / "best"))


def test_training_stops_after_the_patience(pairs, tmp_path):
    impossible = [Pair("sing", '( sing " <name> " )')]
    config = replace(SMALL, epochs=100, patience=2)
    observe = Recorder(tmp_path)
    Seq2Seq(config, seed=1).fit(pairs, impossible, observe)
    best = min(observe.epochs, key=lambda report: report.validation_loss)
    assert len(observe.epochs) == best.epoch + 2 < 100


def test_every_epoch_is_reported(pairs, tmp_path):
    observe = Recorder(tmp_path)
    Seq2Seq(SMALL, seed=1).fit(pairs, pairs[:4], observe)
    first, last = observe.epochs[0], observe.epochs[-1]
    assert last.train_loss < first.train_loss and last.validation_loss < first.validation_loss
    assert 0 <= first.validation_accuracy <= 1 and first.seconds > 0
    assert observe.fractions[-1] == 1


def test_without_validation_pairs_the_last_epoch_is_the_parser(pairs, tmp_path):
    observe = Recorder(tmp_path)
    Seq2Seq(SMALL, seed=1).fit(pairs, (), observe)
    assert observe.epochs[-1].epoch == SMALL.epochs
    assert observe.epochs[-1].validation_accuracy is None
    assert f"epoch {SMALL.epochs}" in observe.lines[-1]


def test_without_training_pairs_it_refuses():
    with pytest.raises(Refusal) as refused:
        Seq2Seq(SMALL).fit([])
    assert refused.value.code == "no_training_pairs"


def test_a_learning_rate_that_diverges_is_said(pairs):
    config = replace(SMALL, learning_rate=1.0)
    parser = Seq2Seq(config)
    parser._read_vocabularies(pairs)
    with torch.no_grad():
        parser._model.decoder.output.weight.fill_(float("inf"))
    training = Training(parser._model, config, parser._generator)
    with pytest.raises(Refusal, match=r"\b1\b.*\b1\b") as refused:
        training.run_epoch(parser._examples(pairs), lambda: None)
    assert refused.value.code == "training_diverged"


def test_saved_and_loaded_it_answers_alike(trained, pairs, tmp_path):
    trained.save(tmp_path / "parser")
    loaded = Seq2Seq.load(tmp_path / "parser")
    asked = [*utterances(pairs), "", "unheard of", "?!"]
    assert loaded.predict(asked, 3) == trained.predict(asked, 3)
    assert loaded.parameters() == trained.parameters() > 0
    assert (loaded.config, loaded.seed) == (trained.config, trained.seed)


def test_candidates_are_distinct_and_ranked(trained, pairs):
    for candidates in trained.predict(utterances(pairs), 3):
        scores = [candidate.score for candidate in candidates]
        assert scores == sorted(scores, reverse=True) and scores[0] <= 0
        assert len({candidate.form for candidate in candidates}) == len(candidates)


def test_the_first_candidate_does_not_depend_on_how_many_are_asked_for(trained, pairs):
    asked = utterances(pairs)
    one, three = trained.predict(asked, 1), trained.predict(asked, 3)
    assert [a[0] for a in one] == [a[0] for a in three]


def test_the_order_of_the_questions_changes_no_answer(trained, pairs):
    asked = utterances(pairs)
    forward = trained.predict(asked)
    backward = trained.predict(asked[::-1])[::-1]
    assert [a[0].form for a in forward] == [a[0].form for a in backward]


def test_nothing_asked_nothing_answered(trained):
    assert trained.predict([]) == []


def test_a_cancelled_prediction_stops_within_a_form(trained):
    calls = []

    def cancel():
        calls.append(1)
        if len(calls) == 3:
            raise Cancelled

    with pytest.raises(Cancelled):
        trained.predict(["bring the <object>"], check=cancel)


def test_an_altered_file_of_weights_is_refused(trained, tmp_path):
    trained.save(tmp_path)
    alter_weights(tmp_path)
    with pytest.raises(Refusal) as refused:
        Seq2Seq.load(tmp_path)
    assert refused.value.code == "saved_file_altered"


def test_a_pickle_under_a_safe_name_is_refused_even_with_its_hash(trained, tmp_path):
    trained.save(tmp_path)
    pickle_weights(tmp_path, weights(trained))
    with pytest.raises(Refusal) as refused:
        Seq2Seq.load(tmp_path)
    assert refused.value.code == "saved_parser_unreadable"


def test_weights_of_another_shape_are_refused(trained, tmp_path):
    trained.save(tmp_path)
    about = read_json(tmp_path / CONFIG)
    about["config"]["hidden_size"] = 64
    write_json(tmp_path / CONFIG, about)
    with pytest.raises(Refusal) as refused:
        Seq2Seq.load(tmp_path)
    assert refused.value.code == "saved_parser_unreadable"


def test_nothing_is_pickled(trained, pairs, tmp_path):
    observe = Recorder(tmp_path)
    Seq2Seq(SMALL, seed=5).fit(pairs[:9], pairs[9:12], observe)
    names = {path.name for path in observe.last_checkpoint().iterdir()}
    assert {name.rsplit(".")[-1] for name in names} == {"json", "safetensors"}


def test_an_odd_hidden_size_is_refused():
    with pytest.raises(Refusal, match=r"hidden_size.* 33") as refused:
        Seq2Seq.Config(hidden_size=33)
    assert refused.value.code == "hyperparameter_out_of_range"


def test_the_parts_of_a_score_are_its_log_probability_and_the_tokens_written(trained, pairs):
    [[best, *_]] = trained.predict([pairs[0].utterance], 2)
    assert best.parts == {"log_probability": best.score, "tokens": len(best.form.split())}
