"""Products from weights of 16 bits: the same numbers, read in half the time."""

import pytest
import torch

from parser_service.neural.sentence_encoder.bert import Bert, BertConfig
from parser_service.neural.sentence_encoder.half_precision import FEW, Linear, rounded

pytestmark = pytest.mark.skipif(
    "fbgemm" not in torch.backends.quantized.supported_engines,
    reason="torch has no such product for this processor",
)


@pytest.fixture
def layer():
    """A layer whose weights are numbers in half precision, the smallest and the largest among them."""
    generator = torch.Generator().manual_seed(5)
    layer = Linear(48, 40)
    with torch.no_grad():
        layer.weight.copy_(rounded(torch.randn(40, 48, generator=generator)))
        layer.weight[0, :4] = torch.tensor([6e-8, -1e-6, 65504.0, 0.0])
        layer.weight.copy_(rounded(layer.weight))
        layer.bias.copy_(torch.randn(40, generator=generator))
    return layer


@pytest.fixture
def bert():
    config = BertConfig(20, 48, 2, 4, 72, 16, 2, 1e-12, 0.1, 0.1, 0)
    network = Bert(config).eval()
    generator = torch.Generator().manual_seed(7)
    with torch.no_grad():
        for weight in network.parameters():
            weight.copy_(rounded(torch.randn(weight.shape, generator=generator) / 4))
    return network


def rows(*shape):
    return torch.randn(*shape, 48, generator=torch.Generator().manual_seed(6))


@pytest.mark.parametrize("shape", [(1, 1), (1, 11), (3, 7), (FEW,), (2, FEW)], ids=str)
@torch.no_grad()
def test_packed_it_gives_the_same_up_to_rounding(layer, shape):
    plain = layer(rows(*shape))
    layer.pack()
    assert torch.allclose(layer(rows(*shape)), plain, rtol=1e-5, atol=1e-4)


@torch.no_grad()
def test_few_rows_read_the_packed_weights_and_many_the_others(layer):
    layer.pack()
    layer.weight.zero_()
    assert not torch.equal(layer(rows(FEW)), layer.bias.expand(FEW, -1))
    assert torch.equal(layer(rows(FEW + 1)), layer.bias.expand(FEW + 1, -1))


def test_weights_that_would_lose_digits_are_not_packed(layer):
    with torch.no_grad():
        layer.weight[3, 3] = 0.1
    layer.pack()
    assert layer._packed is None


def test_gradients_flow_through_a_packed_layer(layer):
    layer.pack()
    layer(rows(2)).sum().backward()
    assert layer.weight.grad.any() and layer.bias.grad.any()


def test_a_packed_network_has_the_same_weights_and_answers(bert):
    subwords = torch.tensor([[5, 7, 2, 9], [1, 3, 0, 0]])
    mask = torch.tensor([[1, 1, 1, 1], [1, 1, 0, 0]])
    weights = {name: weight.clone() for name, weight in bert.state_dict().items()}
    with torch.no_grad():
        before = bert(subwords, mask).last_hidden_state
        bert.pack()
        after = bert(subwords, mask).last_hidden_state
    assert bert.encoder.layer[0].attention.self._packed is not None
    assert torch.allclose(before, after, atol=1e-4)
    assert [*bert.state_dict()] == [*weights]
    assert all(torch.equal(weight, weights[name]) for name, weight in bert.state_dict().items())
    assert torch.equal(bert(subwords, mask).last_hidden_state, before)  # where gradients are wanted
