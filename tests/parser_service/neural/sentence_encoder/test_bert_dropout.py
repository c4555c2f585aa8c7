import pytest
import torch
from torch import nn

from parser_service.neural.sentence_encoder.bert import SharedDropout, share_dropout


@pytest.mark.parametrize("between", [(), (5,), (3, 5)])
def test_a_feature_is_dropped_from_all_words_of_a_text_or_from_none(between):
    torch.manual_seed(1)
    dropped = SharedDropout(0.25)(torch.ones(40, *between, 50))
    texts = dropped.reshape(40, -1, 50)
    assert (texts == texts[:, :1]).all()
    assert dropped.unique().tolist() == [0, pytest.approx(4 / 3)]
    assert dropped.mean().item() == pytest.approx(1, abs=0.05)
    assert not (texts[0] == texts[1]).all()


def test_outside_training_everything_passes():
    values = torch.rand(2, 3, 4)
    assert torch.equal(SharedDropout(0.5).eval()(values), values)
    assert torch.equal(SharedDropout(0.0)(values), values)


def test_every_layer_of_a_network_is_replaced_at_its_own_rate():
    network = nn.Sequential(nn.Dropout(0.1), nn.Sequential(nn.Linear(2, 2), nn.Dropout(0.3)))
    share_dropout(network)
    assert [(type(each), each.p) for each in (network[0], network[1][1])] == [
        (SharedDropout, 0.1),
        (SharedDropout, 0.3),
    ]
    assert isinstance(network[1][0], nn.Linear)
