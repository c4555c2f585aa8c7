"""The ranker as a run: epochs, checkpoints, going on."""

import pytest
import torch

from parser_service.neural.ranker.parser import VALIDATIONS, FormRanker, is_due
from parser_service.parsers.interface import Cancelled
from tests.parser_service.neural.conftest import Recorder
from tests.parser_service.neural.ranker.sample_domain import (
    domain,
    same_weights,
    utterances,
    weights,
)


@pytest.mark.parametrize("checks", [3, 25, 38])
def test_a_stopped_run_goes_on_to_the_same_weights_and_predictions(config, pairs, tmp_path, checks):
    train, validation = pairs[:18], pairs[18:]
    undisturbed = FormRanker(config, seed=5, knowledge=domain())
    undisturbed.fit(train, validation, Recorder(tmp_path / "undisturbed"))
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


def test_an_unreadable_checkpoint_is_said_and_training_starts_again(config, pairs, tmp_path):
    with pytest.raises(Cancelled):
        FormRanker(config, 5).fit(pairs, pairs[:4], Recorder(tmp_path, stop_after_checks=30))
    (tmp_path / "last" / "training.safetensors").write_bytes(b"torn")
    undisturbed, resumed, observe = FormRanker(config, 5), FormRanker(config, 5), None
    undisturbed.fit(pairs, pairs[:4])
    observe = Recorder(tmp_path)
    resumed.fit(pairs, pairs[:4], observe)
    assert any("training starts from the beginning" in line for line in observe.lines)
    assert same_weights(undisturbed, resumed)


def test_the_last_checkpoint_is_the_parser(config, pairs, tmp_path):
    parser, observe = FormRanker(config, seed=5), Recorder(tmp_path)
    parser.fit(pairs[:18], pairs[18:], observe)
    kept = weights(FormRanker.load(tmp_path / "best"))
    assert all(torch.equal(weights(parser)[name], kept[name]) for name in kept)


def test_every_epoch_is_reported(config, pairs, tmp_path):
    observe = Recorder(tmp_path)
    FormRanker(config, seed=1).fit(pairs, pairs[:4], observe)
    first, last = observe.epochs[0], observe.epochs[-1]
    assert last.train_loss < first.train_loss
    assert first.seconds > 0
    assert len(observe.epochs) == -(-config.steps // -(-len(pairs) // config.batch_size))
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
