import pytest
import torch

from parser_service.neural.averaging import Average
from parser_service.neural.gloss_head import GlossHead
from parser_service.neural.pretrained import load_encoder
from parser_service.neural.prototype_head import PrototypeHead
from parser_service.neural.sentence_encoder import LONGEST, SentenceEncoder
from tests.parser_service.neural.tiny_encoder import write_tiny_encoder

TEXTS = ["bring me the apple", "go", "find the apple"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return write_tiny_encoder(tmp_path_factory.mktemp("encoder"), set(TEXTS))


@pytest.fixture
def encoder(folder):
    return SentenceEncoder.of(load_encoder(str(folder)), dropout=0.1).eval()


def test_a_text_has_the_mean_of_its_subwords_whatever_stands_beside_it(encoder, folder):
    pretrained = load_encoder(str(folder))
    for text, vector in zip(TEXTS, encoder.vectors(TEXTS), strict=True):
        cut = pretrained.tokenizer(text, return_tensors="pt")
        inputs = {name: cut[name] for name in ("input_ids", "attention_mask")}
        mean = pretrained.model.eval()(**inputs).last_hidden_state[0].mean(0)
        assert torch.allclose(vector, mean / mean.norm(), atol=1e-5)


def test_vectors_come_in_the_order_asked_for(encoder):
    texts = TEXTS * 50
    vectors = encoder.vectors(texts)
    assert torch.allclose(vectors[: len(TEXTS)], vectors[-len(TEXTS) :], atol=1e-5)


def test_no_text_no_vector(encoder):
    assert encoder.vectors([]).shape == (0, 32)


def test_a_very_long_text_is_cut(encoder):
    assert encoder.vectors(["apple " * 1000]).shape == (1, 32)
    assert len(encoder.tokenizer.encode("apple " * 1000).ids) == LONGEST


def test_described_and_loaded_it_encodes_alike(encoder, tmp_path):
    encoder.describe(tmp_path)
    before = torch.get_rng_state()
    other = SentenceEncoder.described_in(tmp_path).eval()
    assert torch.equal(before, torch.get_rng_state())
    other.load_state_dict(encoder.state_dict())
    assert torch.equal(other.vectors(TEXTS), encoder.vectors(TEXTS))


def test_word_embeddings_are_not_trained(encoder):
    trained = {name for name, weight in encoder.named_parameters() if weight.requires_grad}
    assert not any("word_embeddings" in name for name in trained) and trained


def test_each_prototype_starts_as_the_mean_of_its_examples(encoder):
    head = PrototypeHead(2, 32)
    vectors = encoder.vectors(TEXTS)
    head.start_from(vectors, [1, 0, 1])
    mean = vectors[[0, 2]].mean(0)
    assert torch.allclose(head.prototypes[1], mean / mean.norm(), atol=1e-5)
    assert head(vectors)[1].argmax() == 0
    assert head(vectors)[1, 0].item() == pytest.approx(20, abs=1e-3)


def test_glosses_of_the_targets_carry_gradient_and_the_others_do_not(encoder):
    head = GlossHead(encoder, TEXTS)
    head.renew()
    utterances, logits = head.read(["find me"], [2])
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
