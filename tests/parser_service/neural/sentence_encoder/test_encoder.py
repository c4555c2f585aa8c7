import shutil

import pytest
import torch
from tokenizers.processors import TemplateProcessing

from annotations.language.texts.errors import Refusal
from parser_service.neural.pretrained import load_encoder
from parser_service.neural.sentence_encoder import SentenceEncoder
from parser_service.neural.sentence_encoder.encoder import LONGEST
from parser_service.parsers.registry import parsers
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
    alone = torch.cat([encoder.vectors([text]) for text in TEXTS])
    assert torch.allclose(vectors, alone.repeat(50, 1), atol=1e-5)


def test_no_text_no_vector(encoder):
    assert encoder.vectors([]).shape == (0, 32)


def test_a_text_without_a_subword_has_a_vector_that_is_like_no_other(encoder):
    encoder.tokenizer.post_processor = TemplateProcessing(single="$A", pair="$A $B")
    vectors = encoder.vectors(["", "go"])
    assert vectors[0].tolist() == [0] * 32 and vectors[1].norm() == pytest.approx(1)
    assert not encoder.vectors([""] * 20).any()


def test_a_very_long_text_is_cut(encoder):
    assert encoder.vectors(["apple " * 1000]).shape == (1, 32)
    assert len(encoder.tokenizer.encode("apple " * 1000).ids) == LONGEST
    assert parsers()["ranker"].most_subwords == LONGEST  # as pages say


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


def test_frozen_layers_are_not_trained_and_those_above_are(folder):
    encoder = SentenceEncoder.of(load_encoder(str(folder)), frozen_layers=1)
    encoder(TEXTS).sum().backward()
    changed = {name for name, weight in encoder.named_parameters() if weight.grad is not None}
    assert changed and all(".layer.1." in name for name in changed)


def test_an_encoder_needs_a_layer_that_is_trained(folder):
    with pytest.raises(Refusal) as refused:
        SentenceEncoder.of(load_encoder(str(folder)), frozen_layers=2)
    assert refused.value.code == "hyperparameter_out_of_range"


def test_another_transformer_encodes_and_is_loaded_like_one_of_bert(folder, tmp_path):
    from transformers import MPNetConfig, MPNetModel

    config = MPNetConfig(
        vocab_size=len(load_encoder(str(folder)).tokenizer),
        hidden_size=32,
        num_hidden_layers=2,
        num_attention_heads=2,
        intermediate_size=64,
        max_position_embeddings=80,
    )
    published = tmp_path / "published"
    shutil.copytree(folder, published)
    MPNetModel(config).eval().save_pretrained(published)
    pretrained = load_encoder(str(published))
    encoder = SentenceEncoder.of(pretrained, frozen_layers=1).eval()
    read = [encoder.tokenizer.encode(text).ids for text in TEXTS]
    with torch.no_grad():
        states = [pretrained.model.eval()(torch.tensor([ids])).last_hidden_state[0] for ids in read]
    means = torch.stack([state.mean(0) / state.mean(0).norm() for state in states])
    assert torch.allclose(encoder.vectors(TEXTS), means, atol=1e-5)
    encoder.describe(tmp_path)
    other = SentenceEncoder.described_in(tmp_path).eval()
    other.load_state_dict(encoder.state_dict())
    assert torch.equal(other.vectors(TEXTS), encoder.vectors(TEXTS))
