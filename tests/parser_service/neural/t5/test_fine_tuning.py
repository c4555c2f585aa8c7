"""How the encoder–decoder is trained: resumed, reported, stopped, and what is said about pairs."""

from dataclasses import replace

import pytest
import torch

from annotations.language.texts.errors import Refusal
from parser_service.neural.t5.t5_parser import T5
from parser_service.parsers.interface import Cancelled, Knowledge, Pair
from tests.parser_service.neural.conftest import Recorder
from tests.parser_service.neural.t5.conftest import DECLARED, TWENTY, parser_of
from tests.parser_service.neural.t5.weights import same_weights

pytestmark = pytest.mark.usefixtures("kept_there")


@pytest.mark.parametrize("checks", [0, 22, 27])  # the first 20 are for the examples
def test_a_stopped_run_goes_on_to_the_same_weights(checks, tmp_path):
    longer = {"steps": 5, "accumulation": 2}  # two epochs and a half; two checks a step
    undisturbed, resumed = parser_of(**longer), parser_of(**longer)
    undisturbed.fit(TWENTY)
    observe = Recorder(tmp_path, stop_after_checks=checks)
    with pytest.raises(Cancelled):
        parser_of(**longer).fit(TWENTY, (), observe)
    torch.rand(17)
    observe = Recorder(tmp_path)
    resumed.fit(TWENTY, (), observe)
    assert any("Resuming after step" in line for line in observe.lines) == (checks > 20)
    assert same_weights(undisturbed, resumed)
    assert [report.epoch for report in observe.epochs][-1] == 3


def test_an_unreadable_checkpoint_is_said_and_training_starts_again(tmp_path):
    once, again = parser_of(), parser_of()
    once.fit(TWENTY, (), Recorder(tmp_path))
    (tmp_path / "last" / "training.safetensors").write_bytes(b"torn")
    observe = Recorder(tmp_path)
    again.fit(TWENTY, (), observe)
    assert any("training starts from the beginning" in line for line in observe.lines)
    assert same_weights(once, again)


def test_training_is_reported_and_leaves_the_random_state_and_the_threads_alone(tmp_path):
    before, threads = torch.get_rng_state(), torch.get_num_threads()
    observe = Recorder(tmp_path)
    parser = parser_of()
    parser.fit(TWENTY, TWENTY[:3], observe)
    assert torch.equal(before, torch.get_rng_state()) and torch.get_num_threads() == threads
    first, last = observe.epochs
    assert last.train_loss < first.train_loss and last.validation_loss > 0
    assert 0 <= last.validation_accuracy <= 1 and observe.fractions[-1] == 1
    assert same_weights(parser, T5.load(tmp_path / "best"))


def test_parts_of_a_step_add_up_to_it():
    gradients = []
    for accumulation in (1, 4):
        parser = parser_of(accumulation=accumulation, clip=1e6, precision="fp32")
        training = parser._prepare(TWENTY, Recorder(None))  # in evaluation mode, without dropout
        training._train_on(next(training._shuffle(0)), lambda: None)
        gradients.append([w.grad.clone() for w in training.network.model.parameters()])
    for one, other in zip(*gradients, strict=True):
        torch.testing.assert_close(one, other, atol=1e-5, rtol=1e-3)


def test_it_stops_after_its_minutes_and_says_so(tmp_path):
    observe = Recorder(tmp_path)
    parser_of(steps=1000, minutes=1e-6).fit(TWENTY, (), observe)
    assert "Training ended after 1 of 1000 steps" in observe.lines[-1]
    assert observe.last_checkpoint()


def test_a_loss_that_diverges_is_said():
    parser = parser_of()
    training = parser._prepare(TWENTY, Recorder(None))
    with torch.no_grad():
        training.network.model.get_input_embeddings().weight.fill_(float("inf"))
    with pytest.raises(Refusal, match=r"\b1\b.*0\.01") as refused:
        training.run_step(lambda: None)
    assert refused.value.code == "training_diverged"


def test_an_utterance_that_is_too_long_is_cut_and_that_is_said(tmp_path):
    observe = Recorder(tmp_path)
    parser = parser_of(encoder="bart", steps=1)
    parser.fit([*TWENTY[:9], Pair("bring " * 100, TWENTY[0].form)], (), observe)
    assert "1 of 10 utterances are cut after 40 tokens." in observe.lines
    [[long], [short]] = parser.predict(["bring " * 100, "bring"])
    assert long.parts["cut"] > 60 and "cut" not in short.parts
    assert long.is_cut and not short.is_cut


def test_a_form_that_is_too_long_for_the_network_is_refused():
    places = " ".join(f'( at $1 " <room> " {number} )' for number in range(20))
    pair = Pair("everywhere", f"( find ( lambda $1 e {places} ) )")
    with pytest.raises(Refusal, match=r"\b39\b") as refused:
        parser_of(encoder="bart").fit([*TWENTY, pair])
    assert refused.value.code == "form_too_long_for_network"


def test_pairs_without_a_form_are_left_out_and_that_is_said(tmp_path):
    observe, parser = Recorder(tmp_path), parser_of(steps=1)
    parser.fit([*TWENTY, Pair("sing", "no ( form")], [Pair("sing", "no ( form")], observe)
    assert any("1 of 21 pairs are left out" in line for line in observe.lines)
    with pytest.raises(Refusal) as refused:
        parser.fit([Pair("sing", "no ( form")])
    assert refused.value.code == "no_training_pairs"


def test_forms_that_the_declared_signatures_do_not_allow_are_said(tmp_path):
    declared = {name: each for name, each in DECLARED.items() if name != "bring"}
    observe = Recorder(tmp_path)
    parser_of(knowledge=Knowledge(predicates=declared), steps=1).fit(TWENTY, (), observe)
    assert any("4 of 7 forms of the training pairs are never" in line for line in observe.lines)


def test_without_pairs_or_training_it_refuses():
    with pytest.raises(Refusal) as refused:
        parser_of().fit([])
    assert refused.value.code == "no_training_pairs"
    with pytest.raises(ValueError):
        parser_of().predict(["hello"])


@pytest.mark.parametrize(
    ("field", "value", "code"),
    [
        ("decoding", "greedy", "hyperparameter_out_of_range"),
        ("steps", 0, "hyperparameter_out_of_range"),
        ("encoder", " ", "hyperparameter_missing"),
    ],
)
def test_a_configuration_is_checked(field, value, code):
    with pytest.raises(Refusal, match=field) as refused:
        parser_of(**{field: value})
    assert refused.value.code == code


def test_equal_seeds_give_equal_weights_and_others_do_not():
    one, other, third = parser_of(3), parser_of(3), parser_of(4)
    for parser in (one, other, third):
        parser.fit(TWENTY)
    assert same_weights(one, other) and not same_weights(one, third)


def test_a_form_of_validation_that_cannot_be_spelled_is_just_wrong(tmp_path):
    observe = Recorder(tmp_path)
    unseen = replace(TWENTY[0], form='( sing " <name> " )')
    parser_of(steps=1).fit(TWENTY, [unseen], observe)
    assert (observe.epochs[-1].validation_loss, observe.epochs[-1].validation_accuracy) == (None, 0)
