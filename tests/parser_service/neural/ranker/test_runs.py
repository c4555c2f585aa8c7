"""The ranker as a run: epochs, checkpoints, going on."""

import pytest

from parser_service.neural.ranker.fitting import VALIDATIONS, is_due
from parser_service.neural.ranker.form_ranker import FormRanker
from parser_service.neural.weights import load_tensors
from parser_service.parsers.interface import Cancelled
from tests.parser_service.neural.conftest import Recorder, StoppedOnce
from tests.parser_service.neural.ranker.sample_domain import (
    domain,
    same_weights,
    utterances,
)


@pytest.fixture(scope="module")
def undisturbed(config, pairs, tmp_path_factory) -> FormRanker:
    """What ``config`` learns from the first 18 ``pairs`` when nothing stops it."""
    parser = FormRanker(config, seed=5, knowledge=domain())
    parser.fit(pairs[:18], pairs[18:], Recorder(tmp_path_factory.mktemp("undisturbed")))
    return parser


@pytest.fixture(scope="module")
def undisturbed_by_all(config, pairs) -> FormRanker:
    """What ``config`` learns from all ``pairs``, without a world, when nothing stops it."""
    parser = FormRanker(config, seed=5)
    parser.fit(pairs, pairs[:4])
    return parser


@pytest.mark.parametrize("checks", [3, 60, 130, 190])
def test_a_stopped_run_goes_on_to_the_same_weights_and_predictions(
    config, pairs, tmp_path, undisturbed, checks
):
    train, validation = pairs[:18], pairs[18:]
    stopped = Recorder(tmp_path / "run", stop_after_checks=checks)
    with pytest.raises(Cancelled):
        FormRanker(config, seed=5, knowledge=domain()).fit(train, validation, stopped)
    resumed, observe = FormRanker(config, seed=5, knowledge=domain()), Recorder(tmp_path / "run")
    resumed.fit(train, validation, observe)
    assert same_weights(undisturbed, resumed)
    assert resumed.predict(utterances(pairs), 3) == undisturbed.predict(utterances(pairs), 3)
    epochs = [report.epoch for report in stopped.epochs + observe.epochs]
    assert epochs == list(range(1, len(epochs) + 1))


def test_a_run_lost_after_its_last_epoch_has_the_same_end(config, pairs, tmp_path):
    observe = Recorder(tmp_path)
    finished, again = FormRanker(config, seed=5), FormRanker(config, seed=5)
    finished.fit(pairs[:18], pairs[18:], observe)
    epochs = len(observe.epochs)
    again.fit(pairs[:18], pairs[18:], observe)
    assert len(observe.epochs) == epochs
    assert same_weights(finished, again)
    assert again.predict(utterances(pairs), 3) == finished.predict(utterances(pairs), 3)


def test_an_unreadable_checkpoint_is_said_and_training_starts_again(
    config, pairs, tmp_path, undisturbed_by_all
):
    with pytest.raises(Cancelled):
        FormRanker(config, 5).fit(pairs, pairs[:4], StoppedOnce(tmp_path))
    (tmp_path / "last" / "training.safetensors").write_bytes(b"torn")
    resumed, observe = FormRanker(config, 5), Recorder(tmp_path)
    resumed.fit(pairs, pairs[:4], observe)
    assert any("training starts from the beginning" in line for line in observe.lines)
    assert same_weights(undisturbed_by_all, resumed)


def test_a_checkpoint_holds_what_training_changes_and_nothing_else(config, pairs, tmp_path):
    parser, observe = FormRanker(config, seed=5), Recorder(tmp_path)
    parser.fit(pairs[:18], pairs[18:], observe)
    tensors = load_tensors(tmp_path / "last" / "training.safetensors")
    changed = {name for name, _ in parser._model.trained()}
    assert {name.removeprefix("average.") for name in tensors if name[:8] == "average."} == changed
    assert not any("word_embeddings" in name for name in tensors)


class Unhurried(Recorder):
    """Keeps a checkpoint after every seventh step."""

    steps = 0

    def is_checkpoint_due(self):
        self.steps += 1
        return self.steps % 7 == 0


@pytest.mark.parametrize("stop", [0.3, 0.8], ids=["some forms held out", "with all forms"])
def test_a_run_stopped_within_a_pass_goes_on_from_the_step_that_was_kept(
    config, pairs, tmp_path, undisturbed_by_all, stop
):
    class Stopped(Unhurried):
        def check(self):
            if self.fractions and self.fractions[-1] >= stop:
                raise Cancelled

    with pytest.raises(Cancelled):
        FormRanker(config, seed=5).fit(pairs, pairs[:4], Stopped(tmp_path))
    resumed, observe = FormRanker(config, seed=5), Unhurried(tmp_path)
    resumed.fit(pairs, pairs[:4], observe)
    assert any(line.startswith("Resuming after step") for line in observe.lines)
    assert same_weights(undisturbed_by_all, resumed)
    assert resumed._decision == undisturbed_by_all._decision


def test_every_epoch_is_reported(config, pairs, tmp_path):
    observe = Recorder(tmp_path)
    FormRanker(config, seed=1).fit(pairs, pairs[:4], observe)
    first, last = observe.epochs[0], observe.epochs[-1]
    assert last.train_loss < first.train_loss
    assert first.seconds > 0
    assert [report.epoch for report in observe.epochs] == list(range(1, len(observe.epochs) + 1))
    assert observe.fractions[-1] == 1
    assert "forms of the training pairs" in observe.lines[0]


def test_the_validation_pairs_are_asked_now_and_then_and_at_the_end(config, pairs, tmp_path):
    observe = Recorder(tmp_path)
    FormRanker(config, seed=1).fit(pairs, pairs[:4], observe)
    asked = [report for report in observe.epochs if report.validation_accuracy is not None]
    assert len(asked) == VALIDATIONS < len(observe.epochs)
    assert asked[-1] is observe.epochs[-1]
    assert all(0 <= report.validation_accuracy <= 1 for report in asked)


@pytest.mark.parametrize("epochs", [1, 2, 3])
def test_a_short_training_asks_after_every_epoch(epochs):
    assert all(is_due(epoch, epochs) for epoch in range(1, epochs + 1))


def test_without_validation_pairs_it_learns_all_the_same(config, pairs, tmp_path):
    observe = Recorder(tmp_path)
    FormRanker(config, seed=1).fit(pairs, (), observe)
    assert observe.epochs[-1].validation_accuracy is None
