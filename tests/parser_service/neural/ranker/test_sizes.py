"""Worlds of other sizes than the published one."""

from dataclasses import replace

import pytest
import torch

from parser_service.neural.ranker import ranked_forms
from parser_service.neural.ranker.form_ranker import FormRanker
from parser_service.neural.ranker.steps import RankerTraining, plan
from parser_service.parsers.interface import Cancelled, Observer, Pair
from tests.parser_service.neural.conftest import Recorder
from tests.parser_service.neural.ranker.sample_domain import utterances


@pytest.mark.parametrize("forms", ["open", "closed"])
def test_one_pair_of_one_form_is_answered(config, pairs, forms):
    parser = FormRanker(replace(config, forms=forms, steps=4))
    parser.fit(pairs[:1])
    assert pairs[0].form in [each.form for each in parser.predict([pairs[0].utterance], 5)[0]]


@pytest.mark.parametrize("source", ["generated", "paraphrased"])
def test_pairs_of_one_source_are_enough(config, pairs, source):
    parser = FormRanker(replace(config, steps=4))
    parser.fit([replace(pair, source=source) for pair in pairs])
    assert all(parser.predict(utterances(pairs)))


def test_an_empty_text_has_finite_scores(config, pairs):
    parser = FormRanker(replace(config, steps=4))
    parser.fit(pairs)
    [[best]] = parser.predict([""])
    assert best.score <= 0


@pytest.mark.parametrize(
    ("pairs", "steps", "a_pass"),
    [(1, 400, 1), (50, 400, 2), (2000, 441, 63), (20_000, 400, 400), (200_000, 400, 400)],
)
def test_passes_are_whole_unless_one_is_longer_than_all_steps(config, pairs, steps, a_pass):
    [span] = plan([1.0], [pairs], replace(config, steps=400, batch_size=32))
    assert (span.end, span.total, span.a_pass) == (steps, steps, a_pass)


def test_two_trainings_follow_each_other_on_one_schedule(config):
    first, then = plan([0.5, 0.5], [64, 100], replace(config, steps=30, batch_size=8))
    assert (first.first, first.end, then.first) == (0, 16, 16)
    assert then.end == then.total == first.total == 16 + 26
    assert (first.a_pass, then.a_pass) == (8, 13)


def test_of_very_many_pairs_some_are_read_and_the_log_says_so(config, pairs, tmp_path, monkeypatch):
    monkeypatch.setattr(ranked_forms, "MOST_EXAMPLES", 20)
    observe = Recorder(tmp_path)
    parser = FormRanker(replace(config, steps=4))
    parser.fit(pairs, (), observe)
    assert "Of 28 pairs, 20 are read, of all forms alike." in observe.lines[0]
    assert len(parser._ranked.examples) == 20
    assert len(set(parser._ranked.examples)) == 8


def test_a_pass_that_is_too_long_is_cut_and_the_log_says_so(config, pairs, tmp_path):
    observe = Recorder(tmp_path)
    FormRanker(replace(config, steps=4, batch_size=2)).fit(pairs, (), observe)
    assert any("see 6 of them" in line for line in observe.lines)


def test_of_very_many_glosses_some_are_encoded_again_each_time(learned, monkeypatch):
    monkeypatch.setattr("parser_service.neural.ranker.model.GLOSSES_AT_ONCE", 4)
    model = learned._model
    model.glosses.encode(model.encoder)
    whole = model.glosses.vectors.clone()
    model.glosses.vectors.zero_()
    for turn in range(-(-len(whole) // 4)):
        model.glosses.refresh(model.encoder, turn)
    assert (model.glosses.vectors - whole).abs().max() < 1e-5


def test_of_very_many_examples_prototypes_start_from_some_of_each_form(config, pairs, monkeypatch):
    starts = []
    start = RankerTraining.start

    def note(training, check):
        texts = start(training, check)
        starts.append((texts, training.prototypes.prototypes.detach().norm(dim=-1)))
        return texts

    monkeypatch.setattr("parser_service.neural.ranker.steps.MOST_AVERAGED", 12)
    monkeypatch.setattr(RankerTraining, "start", note)
    FormRanker(replace(config, steps=4, forms="closed")).fit(pairs)
    [(texts, lengths)] = starts
    assert texts == 12 + len(lengths)
    assert torch.allclose(lengths, torch.ones(8))


class Impatient(Observer):
    """Cancels at one of the calls of ``check``, and counts those that come after."""

    def __init__(self, calls: int):
        self.calls = calls

    def check(self):
        self.calls -= 1
        if self.calls <= 0:
            raise Cancelled


@pytest.mark.parametrize("calls", [1, 20, 200])
def test_it_is_cancelled_while_it_makes_candidates_and_while_it_trains(config, calls):
    many = [
        Pair(f"do{verb} the thing {look}", f"( do{verb} ( lambda $1 e ( look{look} $1 ) ) )")
        for verb in range(9)
        for look in range(9)
    ]
    with pytest.raises(Cancelled):
        FormRanker(config).fit(many, (), Impatient(calls))
