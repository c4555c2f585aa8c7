"""Encoder, attention and decoder: padding is invisible, shapes are as their comments say."""

import pytest
import torch

from parser_service.neural.seq2seq.batches import NumberedPair, collate, sources
from parser_service.neural.seq2seq.lstm import BilinearAttention, Dropout, Encoded, Seq2SeqModel
from parser_service.neural.seq2seq.vocabulary import START
from tests.parser_service.neural.conftest import SMALL

SHORT, LONG = [4, 5], [6, 5, 4, 7, 8]


@pytest.fixture(scope="module")
def model():
    model = Seq2SeqModel(SMALL, 12, 9, torch.Generator().manual_seed(1))
    return model.eval()


@torch.no_grad()
def encode(model, *utterances):
    return model.encoder(*sources(utterances))


def test_padding_changes_nothing_that_the_encoder_reads(model):
    alone, padded = encode(model, SHORT), encode(model, LONG, SHORT)
    assert padded.mask.sum(dim=1).tolist() == [len(LONG) + 1, len(SHORT) + 1]
    torch.testing.assert_close(padded.final[1], alone.final[0])
    torch.testing.assert_close(padded.states[1, : len(SHORT) + 1], alone.states[0])


def test_the_encoder_reads_in_both_directions(model):
    whole, changed = encode(model, [4, 5, 6]), encode(model, [4, 5, 9])
    half = SMALL.hidden_size // 2
    torch.testing.assert_close(whole.states[0, 0, :half], changed.states[0, 0, :half])
    assert not torch.equal(whole.states[0, 0, half:], changed.states[0, 0, half:])


def test_attention_sees_no_padding():
    states = torch.randn(1, 3, 4, generator=torch.Generator().manual_seed(1))
    attention, queries = BilinearAttention(4), torch.ones(1, 2, 4)
    mask = torch.tensor([[True, True, False]])
    changed = states.clone()
    changed[0, 2] = 1000
    read = [attention(queries, Encoded(s, mask, states[:, 0])) for s in (states, changed)]
    assert read[0].shape == (1, 2, 4)
    torch.testing.assert_close(read[0], read[1])


def test_attention_to_a_single_word_is_that_word():
    states = torch.randn(1, 3, 4, generator=torch.Generator().manual_seed(1))
    mask = torch.tensor([[False, True, False]])
    read = BilinearAttention(4)(torch.ones(1, 1, 4), Encoded(states, mask, states[:, 0]))
    torch.testing.assert_close(read[0, 0], states[0, 1])


def test_the_decoder_writes_alike_in_one_call_and_token_by_token(model):
    encoded, tokens = encode(model, LONG), torch.tensor([[START, 5, 6, 7]])
    with torch.no_grad():
        together, _ = model.decoder(tokens, model.decoder.start(encoded), encoded)
        state, single = model.decoder.start(encoded), []
        for step in range(4):
            logits, state = model.decoder(tokens[:, step : step + 1], state, encoded)
            single.append(logits)
    assert together.shape == (1, 4, 9)
    torch.testing.assert_close(together, torch.cat(single, dim=1))


def test_padding_does_not_count_in_the_loss(model):
    long, short = NumberedPair(LONG, [4, 5, 6, 7]), NumberedPair(SHORT, [4])
    losses = [model.loss(collate(batch)).item() for batch in ([long], [short], [long, short])]
    tokens = len(long.target) + 1, len(short.target) + 1
    mean = (losses[0] * tokens[0] + losses[1] * tokens[1]) / sum(tokens)
    assert losses[2] == pytest.approx(mean, rel=1e-5)


def test_weights_come_from_the_generator_and_padding_is_zero():
    one, other = (Seq2SeqModel(SMALL, 12, 9, torch.Generator().manual_seed(2)) for _ in range(2))
    for mine, yours in zip(one.parameters(), other.parameters(), strict=True):
        assert torch.equal(mine, yours)
    assert not one.encoder.embedding.weight[0].any()


def test_dropout_keeps_the_mean_and_draws_from_its_generator():
    values = torch.ones(100, 100)
    drawn = [Dropout(0.3, torch.Generator().manual_seed(5))(values) for _ in range(2)]
    assert torch.equal(drawn[0], drawn[1])
    assert drawn[0].mean().item() == pytest.approx(1, abs=0.05)
    assert (drawn[0] == 0).float().mean().item() == pytest.approx(0.3, abs=0.05)


def test_dropout_rests_outside_training():
    values = torch.ones(3)
    assert torch.equal(Dropout(0.9, torch.Generator()).eval()(values), values)
