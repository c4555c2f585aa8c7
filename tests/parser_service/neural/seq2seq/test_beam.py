"""The search against full enumeration on a decoder small enough to enumerate."""

from itertools import product

import pytest
import torch

from parser_service.neural.seq2seq.batches import sources
from parser_service.neural.seq2seq.beam import search
from parser_service.neural.seq2seq.lstm import Seq2SeqModel
from parser_service.neural.seq2seq.vocabulary import END, START
from parser_service.parsers.interface import Cancelled
from tests.parser_service.neural.conftest import SMALL

WORDS = (4, 5, 6)  # what the target vocabulary has beside the special ones
LONGEST = 4


@pytest.fixture(scope="module")
def model():
    model = Seq2SeqModel(SMALL, 12, 4 + len(WORDS), torch.Generator().manual_seed(3)).eval()
    with torch.no_grad():
        model.decoder.output.weight *= 3  # far from uniform, so that hypotheses differ
    return model


@torch.no_grad()
def encode(model, *utterances):
    return model.encoder(*sources(utterances))


@torch.no_grad()
def log_probability(model, encoded, tokens):
    """Of writing ``tokens`` and then END, with the words that a search may not write left out only
    as outcomes, not in the normalisation."""
    inputs, outputs = torch.tensor([[START, *tokens]]), torch.tensor([*tokens, END])
    logits, _ = model.decoder(inputs, model.decoder.start(encoded), encoded)
    steps = torch.log_softmax(logits[0], dim=-1)
    return steps.gather(1, outputs[:, None]).sum().item()


def test_a_wide_beam_finds_the_most_probable_forms(model):
    encoded = encode(model, [4, 5, 6])
    finished = [f for n in range(LONGEST) for f in product(WORDS, repeat=n)]
    probable = sorted(finished, key=lambda f: -log_probability(model, encoded, f))[:3]
    [hypotheses] = search(model.decoder, encoded, width=200, longest=LONGEST)
    ended = [tuple(h.tokens) for h in hypotheses if len(h.tokens) < LONGEST]
    assert ended[:3] == probable


def test_a_score_is_the_log_probability_of_the_form(model):
    encoded = encode(model, [4, 5, 6])
    [hypotheses] = search(model.decoder, encoded, width=5, longest=LONGEST)
    ended = [h for h in hypotheses if len(h.tokens) < LONGEST]
    assert ended
    for hypothesis in ended:
        expected = log_probability(model, encoded, hypothesis.tokens)
        assert hypothesis.score == pytest.approx(expected, abs=1e-4)


def test_utterances_searched_together_and_alone_give_the_same(model):
    utterances = [[4, 5, 6], [7], [], [8, 9, 4, 4, 4, 4]]
    together = search(model.decoder, encode(model, *utterances), width=4, longest=9)
    for utterance, hypotheses in zip(utterances, together, strict=True):
        [alone] = search(model.decoder, encode(model, utterance), width=4, longest=9)
        assert [h.tokens for h in alone] == [h.tokens for h in hypotheses]


def test_hypotheses_are_distinct_ranked_and_of_known_words(model):
    [hypotheses] = search(model.decoder, encode(model, [4]), width=30, longest=3)
    texts = [tuple(h.tokens) for h in hypotheses]
    assert len(set(texts)) == len(texts)
    assert [h.score for h in hypotheses] == sorted((h.score for h in hypotheses), reverse=True)
    assert {token for text in texts for token in text} <= set(WORDS)


def test_a_beam_wider_than_the_vocabulary_gives_no_impossible_form(model):
    [hypotheses] = search(model.decoder, encode(model, [4]), width=50, longest=1)
    assert len(hypotheses) == len(WORDS) + 1


def test_a_wider_beam_is_never_worse_than_greedy_search_here(model):
    encoded = encode(model, [4, 5], [6, 7, 8])
    for greedy, wide in zip(
        search(model.decoder, encoded, 1, 6), search(model.decoder, encoded, 8, 6), strict=True
    ):
        assert wide[0].score >= greedy[0].score - 1e-5


def test_the_search_can_be_cancelled_between_tokens(model):
    def cancel():
        raise Cancelled

    with pytest.raises(Cancelled):
        search(model.decoder, encode(model, [4]), 2, 5, cancel)
