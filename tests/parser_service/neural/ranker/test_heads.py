import pytest
import torch

from parser_service.neural.pretrained import load_encoder
from parser_service.neural.ranker.averaging import Average
from parser_service.neural.ranker.model import GlossHead, PrototypeHead
from parser_service.neural.sentence_encoder import SentenceEncoder
from tests.parser_service.neural.tiny_encoder import write_tiny_encoder

TEXTS = ["bring me the apple", "go", "find the apple"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return write_tiny_encoder(tmp_path_factory.mktemp("encoder"), set(TEXTS))


@pytest.fixture
def encoder(folder):
    return SentenceEncoder.of(load_encoder(str(folder)), dropout=0.1).eval()


def test_each_prototype_starts_as_the_mean_of_its_examples(encoder):
    head = PrototypeHead(2, 32)
    vectors = encoder.vectors(TEXTS)
    head.start_from(vectors, [1, 0, 1])
    mean = vectors[[0, 2]].mean(0)
    assert torch.allclose(head.prototypes[1], mean / mean.norm(), atol=1e-5)
    assert head(vectors)[1].argmax() == 0
    assert head(vectors)[1, 0].item() == pytest.approx(20, abs=1e-3)


def test_glosses_of_the_targets_carry_gradient_and_the_others_do_not(encoder):
    head = GlossHead(TEXTS, encoder.width)
    head.encode(encoder)
    utterances, logits = head.read(encoder, ["find me"], [2])
    assert torch.allclose(utterances, encoder.vectors(["find me"]), atol=1e-5)
    alone = head.logits(utterances)  # with gradient to the utterance alone
    assert torch.allclose(logits, alone, atol=1e-4)
    weight = encoder.model.encoder.layer[0].output.dense.weight
    for gloss, is_trained in ((0, False), (1, False), (2, True)):
        slopes = [
            torch.autograd.grad(each[0, gloss], weight, retain_graph=True)[0]
            for each in (logits, alone)
        ]
        assert torch.allclose(*slopes, atol=1e-5) != is_trained


SHAPES = {"matrix": (2, 3), "bias": (2,)}


def test_the_average_follows_the_weights_and_gives_them_back():
    weight = torch.nn.Parameter(torch.zeros(1))
    average = Average([("weight", weight)], decay=0.5)
    weight.data.fill_(1.0)
    average.update(1)  # (1 + 1) / (10 + 1) is below 0.5
    assert average.values["weight"].item() == pytest.approx(9 / 11)
    with average.in_force():
        assert weight.item() == pytest.approx(9 / 11)
        assert average.live["weight"].item() == 1.0
    assert weight.item() == 1.0
    average.keep()
    assert weight.item() == pytest.approx(9 / 11)


def test_the_average_goes_back_towards_the_first_weights():
    first = {name: torch.nn.Parameter(torch.zeros(1)) for name in ("near", "far")}
    average = Average(first.items(), decay=0.0, kept={"near": 0.25, "far": 0.0})
    for weight in first.values():
        weight.data.fill_(1.0)
    average.update(1)
    average.keep()
    assert first["near"].item() == pytest.approx(0.75) and first["far"].item() == 1.0
    assert average.values["near"].item() == 1.0


def test_of_the_average_matrices_are_given_in_half_precision():
    weights = {name: torch.nn.Parameter(torch.full(shape, 0.1)) for name, shape in SHAPES.items()}
    average = Average(weights.items(), decay=0.5)
    average.keep()
    assert torch.equal(weights["matrix"], torch.full((2, 3), 0.1).half().float())
    assert torch.equal(weights["bias"], torch.full((2,), 0.1))
    assert torch.equal(average.values["matrix"], torch.full((2, 3), 0.1))
