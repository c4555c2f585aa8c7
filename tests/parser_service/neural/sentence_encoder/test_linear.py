"""Products from weights of 16 bits: the same numbers, read in half the time."""

import pytest
import torch

from parser_service.neural.sentence_encoder.linear import FEW, Linear, pack, rounded

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


def test_a_packed_network_has_the_same_weights_by_name(layer):
    network = torch.nn.Sequential(layer, torch.nn.GELU(), torch.nn.Linear(40, 3))
    before = {name: weight.clone() for name, weight in network.state_dict().items()}
    pack(network)
    assert layer._packed is not None
    assert [*network.state_dict()] == [*before]
    assert all(torch.equal(weight, before[name]) for name, weight in network.state_dict().items())
