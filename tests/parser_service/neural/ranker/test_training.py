"""What a ranker learns from, and what may not matter to it."""

import re
from dataclasses import replace

import pytest
import torch

from annotations.language.texts.errors import Refusal
from annotations.language.world import Entity, Ontology
from parser_service.neural.pretrained import load_encoder
from parser_service.neural.ranker.form_ranker import FormRanker
from parser_service.neural.ranker.steps import RankerTraining
from parser_service.neural.sentence_encoder.half_precision import rounded
from parser_service.parsers.interface import Knowledge, Pair
from tests.parser_service.neural.ranker.sample_domain import (
    domain,
    same_weights,
    utterances,
    weights,
)


def test_equal_seeds_give_equal_weights_whatever_else_draws_random_numbers(config, pairs):
    one, other = FormRanker(config, seed=3), FormRanker(config, seed=3)
    one.fit(pairs[:12], pairs[12:])
    torch.rand(17)
    other.fit(pairs[:12], pairs[12:])
    assert same_weights(one, other)
    assert one.predict(utterances(pairs), 3) == other.predict(utterances(pairs), 3)


def test_training_leaves_the_global_random_state_and_the_threads_alone(config, pairs):
    before, threads = torch.get_rng_state(), torch.get_num_threads()
    FormRanker(config, seed=3).fit(pairs[:9])
    assert torch.equal(before, torch.get_rng_state())
    assert torch.get_num_threads() == threads


def test_another_seed_gives_other_weights(config, pairs):
    one, other = FormRanker(config, seed=3), FormRanker(config, seed=4)
    one.fit(pairs)
    other.fit(pairs)
    assert not same_weights(one, other)


def test_a_strict_run_given_a_poisoned_world_trains_unchanged(config, pairs):
    poison = Ontology((Entity("object", "bring"), Entity("room", "find")))
    poisoned = Knowledge({}, poison, ())
    clean, limited = FormRanker(config, seed=2), None
    clean.fit(pairs[:12], pairs[12:])
    limited = FormRanker(config, seed=2, knowledge=poisoned.limited_to("strict"))
    limited.fit(pairs[:12], pairs[12:])
    assert same_weights(clean, limited)
    assert clean.predict(utterances(pairs), 3) == limited.predict(utterances(pairs), 3)


def test_the_ontology_changes_a_run_of_the_domain(config, pairs):
    strict, domestic = FormRanker(config, seed=2), FormRanker(config, 2, domain())
    strict.fit(pairs)
    domestic.fit(pairs)
    assert not same_weights(strict, domestic)


def texts_of_a_training(pairs, knowledge, config, monkeypatch):
    seen = []
    read = RankerTraining._text
    monkeypatch.setattr(RankerTraining, "_text", lambda *args: seen.append(read(*args)) or seen[-1])
    FormRanker(replace(config, steps=400), 0, knowledge).fit(pairs)
    return set(seen)


def test_in_the_domain_training_reads_utterances_with_other_entities(config, pairs, monkeypatch):
    spoken = Pair("bring the apple to me", pairs[0].form, "paraphrased")
    generated = Pair("please fetch the <object>", pairs[0].form, "generated")
    seen = texts_of_a_training([*pairs, spoken, generated], domain(), config, monkeypatch)
    assert {text for text in seen if re.fullmatch(r"bring the \S+ to me", text)} == {
        "bring the apple to me",
        "bring the jam to me",
    }
    assert {text for text in seen if re.fullmatch(r"please fetch the \S+", text)} == {
        "please fetch the <object>",
        "please fetch the apple",
        "please fetch the jam",
    }


def test_strictly_it_reads_them_as_they_are(config, pairs, monkeypatch):
    spoken = Pair("bring the apple to me", pairs[0].form, "paraphrased")
    seen = texts_of_a_training([*pairs, spoken], Knowledge(), config, monkeypatch)
    assert seen == {pair.utterance for pair in [*pairs, spoken]}


def test_without_training_pairs_it_refuses(config):
    with pytest.raises(Refusal) as refused:
        FormRanker(config).fit([])
    assert refused.value.code == "no_training_pairs"


def test_a_missing_encoder_is_said_before_training(config, pairs, tmp_path, monkeypatch):
    monkeypatch.setattr("parser_service.neural.ranker.fitting.encoders_folder", lambda: tmp_path)
    with pytest.raises(Refusal, match=f"{tmp_path}/absent") as refused:
        FormRanker(replace(config, encoder="absent")).fit(pairs)
    assert refused.value.code == "pretrained_weights_missing"


def test_a_learning_rate_that_diverges_is_said(config, pairs, monkeypatch):
    monkeypatch.setattr(RankerTraining, "_train_on", lambda *_: float("nan"))
    with pytest.raises(Refusal, match=rf"\b1\b.*{config.learning_rate:g}") as refused:
        FormRanker(config).fit(pairs)
    assert refused.value.code == "training_diverged"


def test_the_encoder_goes_back_to_the_pretrained_one_as_far_as_the_protocol_says(config, pairs):
    whole = replace(config, steps=2, pretrained_share=0.5, pretrained_share_domain=1.0)
    strict, domestic = FormRanker(whole), FormRanker(whole, knowledge=domain())
    pretrained = load_encoder(config.encoder).model.state_dict()
    for parser in (strict, domestic):
        parser.fit(pairs)
    name = "encoder.layer.0.output.dense.weight"
    assert torch.equal(weights(domestic)[f"encoder.model.{name}"], rounded(pretrained[name]))
    assert not torch.equal(weights(strict)[f"encoder.model.{name}"], rounded(pretrained[name]))


def test_the_optimizer_goes_on_with_its_moments_when_the_held_out_forms_join(
    config, pairs, monkeypatch
):
    steps_seen = {}
    train = RankerTraining._train_on

    def note(training, *args):
        loss = train(training, *args)
        states = (training.optimizer.state[weight] for _, weight in training.model.trained())
        steps_seen[training.step] = {int(state["step"]) for state in states if state}
        return loss

    monkeypatch.setattr(RankerTraining, "_train_on", note)
    FormRanker(replace(config, steps=12)).fit(pairs)
    assert len(steps_seen) >= 12
    assert all(seen == {step + 1} for step, seen in steps_seen.items())
