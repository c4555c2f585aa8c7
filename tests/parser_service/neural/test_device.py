"""The same code on the CPU and on a GPU: on a real one where there is one, on a fake one
everywhere."""

import pytest
import torch

from parser_service.neural.device import bf16_on_gpu, denormals_flushed, full_fp32
from parser_service.neural.seq2seq.batches import NumberedPair, collate, sources
from parser_service.neural.seq2seq.lstm import Dropout, Seq2SeqModel
from parser_service.neural.word_vectors.contextual import TransformerWords
from parser_service.parsers.interface import Cancelled
from parser_service.parsers.words import words
from tests.parser_service.neural.conftest import SMALL, Recorder, StoppedOnce, parser_of
from tests.parser_service.neural.fake_device import CPU, FAKE, computing_on

GPU = pytest.param(
    torch.device("cuda"),
    marks=pytest.mark.skipif(not torch.cuda.is_available(), reason="there is no GPU"),
)
pytestmark = [
    pytest.mark.usefixtures("kept_there"),
    # torch takes the fake device for one without data, and warns that loading has no effect
    pytest.mark.filterwarnings("ignore:for .* copying from a non-meta parameter"),
]


def forms(answers):
    return [[candidate.form for candidate in candidates] for candidates in answers]


def scores(answers):
    return [candidate.score for candidates in answers for candidate in candidates]


def agree(one, other, tolerance=1e-3):
    return forms(one) == forms(other) and scores(one) == pytest.approx(scores(other), abs=tolerance)


@pytest.mark.parametrize("device", [FAKE, GPU], ids=str)
@pytest.mark.parametrize("name", ["seq2seq", "seq2seq-glove-elmo", "seq2seq-minilm"])
def test_a_parser_trained_elsewhere_answers_alike_on_the_cpu(name, device, pairs, tmp_path):
    train, validation, asked = pairs[:10], pairs[10:12], [pairs[0].utterance, "", "☃"]
    with computing_on(device):
        parser, run = parser_of(name), Recorder(tmp_path / "run")
        parser.fit(train, validation, run)
        assert {weights.device.type for weights in parser._model.parameters()} == {device.type}
        there = parser.predict(asked, 2)
        parser.save(tmp_path / "saved")
        assert type(parser).load(tmp_path / "saved").predict(asked, 2) == there
    with computing_on(CPU):
        loaded = type(parser).load(tmp_path / "saved")
        assert agree(loaded.predict(asked, 2), there)
        loaded.save(tmp_path / "saved again")
    with computing_on(device):
        again = type(parser).load(tmp_path / "saved again")
        assert again.predict(asked, 2) == there


@pytest.mark.parametrize("device", [FAKE, GPU], ids=str)
@pytest.mark.parametrize(("first", "then"), [("there", "here"), ("here", "there")])
def test_a_run_goes_on_on_another_processor(first, then, device, pairs, tmp_path):
    places, undisturbed = {"here": CPU, "there": device}, Recorder(tmp_path / "undisturbed")
    with computing_on(CPU):
        parser_of("seq2seq").fit(pairs[:10], pairs[10:12], undisturbed)
    run = StoppedOnce(tmp_path / "run")
    with computing_on(places[first]), pytest.raises(Cancelled):
        parser_of("seq2seq").fit(pairs[:10], pairs[10:12], run)
    with computing_on(places[then]):
        parser_of("seq2seq").fit(pairs[:10], pairs[10:12], run)
    assert [report.epoch for report in run.epochs] == [1, 2, 3]
    expected = undisturbed.epochs[-1].train_loss
    tolerance = 1e-5 if device == FAKE else 0.05  # a GPU trains in bf16
    assert run.epochs[-1].train_loss == pytest.approx(expected, rel=tolerance)


@pytest.mark.parametrize("device", [FAKE, GPU], ids=str)
@pytest.mark.parametrize("name", ["seq2seq-minilm", "seq2seq-glove-gpt", "seq2seq-glove-elmo"])
def test_frozen_encoders_read_alike_everywhere_into_the_main_memory(name, device, pairs):
    sentence, vectors = words(pairs[-1].utterance), {}
    for place in (CPU, device):
        with computing_on(place):
            vectors[place] = parser_of(name)._context(sentence)
    assert vectors[device].device == CPU and vectors[device].dtype == torch.float32
    torch.testing.assert_close(vectors[device], vectors[CPU])


@pytest.mark.parametrize("device", [FAKE, GPU], ids=str)
def test_a_frozen_transformer_is_moved_there(device, encoders):
    with computing_on(device):
        assert TransformerWords.named(str(encoders / "bert"))._model.device.type == device.type


@pytest.mark.parametrize("device", [FAKE, GPU], ids=str)
def test_dropout_drops_the_same_everywhere(device):
    values, dropped = torch.ones(50, 20), {}
    for place in (CPU, device):
        with computing_on(place):
            dropout = Dropout(0.3, torch.Generator().manual_seed(5))
            dropped[place] = dropout(values.to(place)).cpu()
    assert torch.equal(dropped[CPU], dropped[device])


def test_the_fake_device_refuses_what_a_gpu_refuses():
    with computing_on(FAKE):
        fake = torch.ones(2, 3).to(FAKE)
        assert (fake + 1).sum().item() == 12
        for mixing in (
            lambda: fake + torch.ones(2, 3),
            lambda: torch.cat((fake, torch.ones(2, 3))),
            lambda: fake @ torch.ones(3, 2),
            lambda: torch.where(torch.ones(2, 3, dtype=torch.bool), fake, fake),
            lambda: fake.bernoulli_(0.5, generator=torch.Generator()),
            lambda: torch.nn.functional.embedding(torch.tensor([1]), fake),
        ):
            with pytest.raises(RuntimeError, match="mixes tensors on the CPU and on"):
                mixing()


def test_bf16_in_attention_and_output_hardly_moves_the_loss_and_its_gradient():
    """What ``bf16_on_gpu`` asks of a GPU, asked of the CPU."""
    model = Seq2SeqModel(SMALL, 12, 9, torch.Generator().manual_seed(1)).eval()
    encoded = model.encoder(*sources([[4, 5, 6], [7]]))
    written, _ = model.decoder.write(torch.tensor([[5, 6], [7, 8]]), model.decoder.start(encoded))
    slopes = {}
    for is_reduced in (False, True):
        model.zero_grad()
        with torch.autocast("cpu", torch.bfloat16, enabled=is_reduced):
            logits = model.decoder.logits(written, encoded)
        assert logits.dtype == (torch.bfloat16 if is_reduced else torch.float32)
        logits.float().logsumexp(-1).sum().backward(retain_graph=True)
        slopes[is_reduced] = model.decoder.combine.weight.grad.clone()
    assert slopes[True].dtype == torch.float32
    difference = (slopes[True] - slopes[False]).norm() / slopes[False].norm()
    assert 0 < difference < 0.05


def test_on_the_cpu_nothing_is_in_bf16_and_full_fp32_changes_nothing():
    left = torch.randn(8, 8, generator=torch.Generator().manual_seed(1))
    with bf16_on_gpu(CPU), full_fp32():
        product = left @ left
    assert torch.equal(product, left @ left)


def test_the_loss_is_in_fp32():
    model = Seq2SeqModel(SMALL, 12, 9, torch.Generator().manual_seed(1))
    assert model.loss(collate([NumberedPair([4], [5])])).dtype == torch.float32


def test_denormal_numbers_are_zero_inside_the_block_alone():
    tiny = torch.full((4,), 1e-39)
    assert (tiny / 2).all()
    with denormals_flushed():
        with denormals_flushed():
            assert not (tiny / 2).any()
        assert not (tiny / 2).any()
    assert (tiny / 2).all()
