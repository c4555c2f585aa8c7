"""The fine-tuned encoder–decoder: what it learns, answers and refuses."""

import json
from dataclasses import replace

import pytest
import torch
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from safetensors.torch import load_file, save_file

from annotations.language.forms import read_form
from annotations.language.predicates import check_form, infer_signatures
from parser_service.neural.t5.network import shared_weights
from parser_service.neural.t5.parser import T5
from parser_service.neural.t5.training import summed_loss
from parser_service.parsers.interface import Cancelled, Knowledge, Pair
from parser_service.parsers.logical_forms import canonical
from tests.parser_service.neural.conftest import Recorder, form
from tests.parser_service.neural.t5.conftest import TWENTY, parser_of
from tests.parser_service.neural.tiny_encoder_decoder import write_bart, write_t5
from tests.parser_service.neural.tiny_weights import write_bert

pytestmark = pytest.mark.usefixtures("kept_there")
UTTERANCES = [pair.utterance for pair in TWENTY]
ODD = ["", "☃", "bring " * 100, "unheard of\n\tλ"]
DECLARED = infer_signatures(
    map(read_form, [*(pair.form for pair in TWENTY), '( greet " <gesture> " )'])
)


def weights(parser):
    return {name: value.detach().clone() for name, value in parser._network.tensors().items()}


def same_weights(one, other):
    return all(torch.equal(value, weights(other)[name]) for name, value in weights(one).items())


def make_random(parser, seed):
    """Gives a parser far-off weights, so that it writes whatever it may."""
    with torch.random.fork_rng(devices=[]), torch.no_grad():
        torch.manual_seed(seed)
        for tensor in parser._network.tensors().values():
            tensor.normal_(std=0.5)
    return parser


@pytest.fixture(scope="module")
def untrained(writers):
    """A parser of each decoding, and one that lists under domain, after one step."""

    def after_a_step(decoding, knowledge=None, encoder="t5"):
        parser = parser_of(1, knowledge, decoding=decoding, steps=1, encoder=encoder)
        parser.fit(TWENTY)
        return parser

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("parser_service.parsers.encoder_places._encoders", writers)
        domain = Knowledge(predicates=DECLARED)
        return {
            "free": after_a_step("free"),
            "listed": after_a_step("listed"),
            "typed": after_a_step("typed"),
            "typed bart": after_a_step("typed", encoder="bart"),
            "listed domain": after_a_step("listed", domain),
            "typed domain": after_a_step("typed", domain),
        }


def test_it_learns_twenty_pairs_by_heart(learned):
    answers = learned.predict(UTTERANCES)
    assert [answer[0].form for answer in answers] == [pair.form for pair in TWENTY]


def test_candidates_are_distinct_ranked_and_of_known_origin(learned):
    for answer in learned.predict(UTTERANCES[:4], 3):
        assert len({candidate.form for candidate in answer}) == len(answer) == 3
        scores = [candidate.score for candidate in answer]
        assert scores == sorted(scores, reverse=True) and scores[0] < 0
        assert answer[0].origin == "training"


def test_a_score_is_the_log_probability_of_what_was_written(learned):
    [[best, *_]] = learned.predict(UTTERANCES[:1], 2)
    [example] = learned._examples([Pair(UTTERANCES[0], best.form)], lambda: None)
    with torch.no_grad():
        loss = summed_loss(learned._network, [example]).item()
    assert best.score == pytest.approx(-loss, abs=1e-4)
    assert best.parts == {"log_probability": best.score, "tokens": len(example.target) - 1}


def test_utterances_asked_together_and_alone_are_answered_alike(learned):
    asked = [*UTTERANCES[:6], *ODD]
    together = learned.predict(asked, 2)
    for utterance, answer in zip(asked, together, strict=True):
        [alone] = learned.predict([utterance], 2)
        assert [each.form for each in alone] == [each.form for each in answer]


def test_saved_and_loaded_it_answers_alike(learned, tmp_path):
    learned.save(tmp_path)
    loaded = T5.load(tmp_path)
    assert loaded.predict([*UTTERANCES, *ODD], 2) == learned.predict([*UTTERANCES, *ODD], 2)
    assert loaded.parameters() == learned.parameters() > 0
    assert (loaded.config, loaded.seed) == (learned.config, learned.seed)
    assert {path.suffix for path in tmp_path.iterdir()} == {".json", ".safetensors"}


@pytest.mark.parametrize("name", ["listed", "listed domain"])
def test_what_is_listed_is_never_left(name, untrained):
    parser = untrained[name]
    listed = set(parser._targets.origins)
    for seed in range(2):
        for answer in make_random(parser, seed).predict([*UTTERANCES[:3], *ODD], 8):
            assert answer and {candidate.form for candidate in answer} <= listed


def test_a_list_shorter_than_the_beam_is_answered_whole(untrained):
    parser = untrained["listed"]
    listed = parser._targets.origins
    [answer] = parser.predict([UTTERANCES[0]], len(listed) + 20)
    assert {candidate.form for candidate in answer} == set(listed)


@pytest.mark.parametrize("name", ["typed", "typed bart", "typed domain"])
@settings(
    max_examples=4, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(seed=st.integers(0, 10**6), texts=st.lists(st.text(max_size=30), min_size=1, max_size=2))
def test_every_typed_answer_passes_the_checker(name, untrained, seed, texts):
    known = {
        "typed domain": DECLARED,
    }.get(name, infer_signatures(read_form(pair.form) for pair in TWENTY))
    for answer in make_random(untrained[name], seed).predict(texts, 2):
        assert answer
        for candidate in answer:
            assert canonical(candidate.form) == candidate.form
            assert not check_form(read_form(candidate.form), known)


def test_what_is_freely_written_may_be_no_form(untrained):
    answers = make_random(untrained["free"], 1).predict(UTTERANCES[:3], 2)
    assert any(canonical(candidate.form) is None for answer in answers for candidate in answer)


def test_strict_gets_no_domain_knowledge_and_domain_more_forms(untrained):
    strict, domain = untrained["listed"], untrained["listed domain"]
    of_pairs = {pair.form for pair in TWENTY}
    assert set(strict._targets.origins) == of_pairs < set(domain._targets.origins)
    assert "greet" not in json.dumps([strict._targets.to_json(), strict._network.atoms])
    assert {"greet:", ":<gesture>"} <= set(domain._network.atoms)


@pytest.mark.parametrize("checks", [0, 22, 27])  # the first 20 are for the examples
def test_a_stopped_run_goes_on_to_the_same_weights(checks, tmp_path):
    longer = {"steps": 5, "accumulation": 2}  # two epochs and a half; two checks a step
    undisturbed, resumed = parser_of(**longer), parser_of(**longer)
    undisturbed.fit(TWENTY)
    observe = Recorder(tmp_path, stop_after_checks=checks)
    with pytest.raises(Cancelled):
        parser_of(**longer).fit(TWENTY, (), observe)
    torch.rand(17)
    observe = Recorder(tmp_path)
    resumed.fit(TWENTY, (), observe)
    assert any("Resuming after step" in line for line in observe.lines) == (checks > 20)
    assert same_weights(undisturbed, resumed)
    assert [report.epoch for report in observe.epochs][-1] == 3


def test_an_unreadable_checkpoint_is_said_and_training_starts_again(tmp_path):
    once, again = parser_of(), parser_of()
    once.fit(TWENTY, (), Recorder(tmp_path))
    (tmp_path / "last" / "training.safetensors").write_bytes(b"torn")
    observe = Recorder(tmp_path)
    again.fit(TWENTY, (), observe)
    assert any("training starts from the beginning" in line for line in observe.lines)
    assert same_weights(once, again)


def test_training_is_reported_and_leaves_the_random_state_and_the_threads_alone(tmp_path):
    before, threads = torch.get_rng_state(), torch.get_num_threads()
    observe = Recorder(tmp_path)
    parser = parser_of()
    parser.fit(TWENTY, TWENTY[:3], observe)
    assert torch.equal(before, torch.get_rng_state()) and torch.get_num_threads() == threads
    first, last = observe.epochs
    assert last.train_loss < first.train_loss and last.validation_loss > 0
    assert 0 <= last.validation_accuracy <= 1 and observe.fractions[-1] == 1
    assert same_weights(parser, T5.load(tmp_path / "best"))


def test_parts_of_a_step_add_up_to_it():
    gradients = []
    for accumulation in (1, 4):
        parser = parser_of(accumulation=accumulation, clip=1e6, precision="fp32")
        training = parser._prepare(TWENTY, Recorder(None))  # in evaluation mode, without dropout
        training._train_on(training._batch(), lambda: None)
        gradients.append([w.grad.clone() for w in training.network.model.parameters()])
    for one, other in zip(*gradients, strict=True):
        torch.testing.assert_close(one, other, atol=1e-5, rtol=1e-3)


def test_it_stops_after_its_minutes_and_says_so(tmp_path):
    observe = Recorder(tmp_path)
    parser_of(steps=1000, minutes=1e-6).fit(TWENTY, (), observe)
    assert "Training ended after 1 of 1000 steps" in observe.lines[-1]
    assert observe.last_checkpoint()


def test_a_loss_that_diverges_is_said():
    parser = parser_of()
    training = parser._prepare(TWENTY, Recorder(None))
    with torch.no_grad():
        training.network.model.get_input_embeddings().weight.fill_(float("inf"))
    with pytest.raises(
        ValueError, match=r"Training diverged in epoch 1.*learning rate below 0\.01"
    ):
        training.run_step(lambda: None)


def test_an_utterance_that_is_too_long_is_cut_and_that_is_said(tmp_path):
    observe = Recorder(tmp_path)
    parser = parser_of(encoder="bart", steps=1)
    parser.fit([*TWENTY[:9], Pair("bring " * 100, TWENTY[0].form)], (), observe)
    assert "1 of 10 utterances are cut after 40 tokens." in observe.lines
    [[long], [short]] = parser.predict(["bring " * 100, "bring"])
    assert long.parts["cut"] > 60 and "cut" not in short.parts
    assert long.is_cut and not short.is_cut


def test_a_form_that_is_too_long_for_the_network_is_refused():
    places = " ".join(f'( at $1 " <room> " {number} )' for number in range(20))
    pair = Pair("everywhere", f"( find ( lambda $1 e {places} ) )")
    with pytest.raises(ValueError, match="writes at most 39 tokens, but a form"):
        parser_of(encoder="bart").fit([*TWENTY, pair])


def test_pairs_without_a_form_are_left_out_and_that_is_said(tmp_path):
    observe, parser = Recorder(tmp_path), parser_of(steps=1)
    parser.fit([*TWENTY, Pair("sing", "no ( form")], [Pair("sing", "no ( form")], observe)
    assert any("1 of 21 pairs are left out" in line for line in observe.lines)
    with pytest.raises(ValueError, match="No training pair has a form that can be read"):
        parser.fit([Pair("sing", "no ( form")])


def test_forms_that_the_declared_signatures_do_not_allow_are_said(tmp_path):
    declared = {name: each for name, each in DECLARED.items() if name != "bring"}
    observe = Recorder(tmp_path)
    parser_of(knowledge=Knowledge(predicates=declared), steps=1).fit(TWENTY, (), observe)
    assert any("4 of 7 forms of the training pairs are never" in line for line in observe.lines)


def test_a_prediction_can_be_cancelled_between_tokens(learned):
    calls = []

    def cancel():
        calls.append(1)
        if len(calls) == 3:
            raise Cancelled

    with pytest.raises(Cancelled):
        learned.predict(UTTERANCES[:2], check=cancel)


def test_pickled_weights_are_refused_before_training(tmp_path):
    folder = write_t5(tmp_path / "pickled")
    state = {"weights": torch.zeros(3)}
    torch.save(state, folder / "model.safetensors")
    with pytest.raises(ValueError, match="holds no encoder–decoder that can be read"):
        parser_of(encoder=str(folder)).fit(TWENTY)
    (folder / "model.safetensors").rename(folder / "pytorch_model.bin")
    with pytest.raises(ValueError, match="holds only pickled weights, which are never read"):
        parser_of(encoder=str(folder)).fit(TWENTY)


def test_code_that_comes_with_weights_is_not_run(tmp_path):
    folder = write_bart(tmp_path / "coded")
    config = json.loads((folder / "config.json").read_text())
    maps = {"AutoConfig": "code.Config", "AutoModelForSeq2SeqLM": "code.Model"}
    (folder / "config.json").write_text(json.dumps({**config, "model_type": "x", "auto_map": maps}))
    (folder / "code.py").write_text(f"open({str(tmp_path / 'ran')!r}, 'w')")
    with pytest.raises(ValueError, match="holds no encoder–decoder that can be read"):
        parser_of(encoder=str(folder)).fit(TWENTY)
    assert not (tmp_path / "ran").exists()


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda folder: (folder / "tokenizer.json").unlink(), "holds no tokenizer.json"),
        (lambda folder: write_bert(folder), "holds no encoder–decoder that can be read"),
        (lambda folder: _forget(folder, "decoder_start_token_id"), "has no decoder_start_token_id"),
        (lambda folder: _shrink(folder), "knows more tokens than the network has vectors"),
    ],
)
def test_files_that_do_not_make_an_encoder_decoder_are_refused(change, sentence, tmp_path):
    folder = write_t5(tmp_path / "wrong")
    change(folder)
    with pytest.raises(ValueError, match=sentence):
        parser_of(encoder=str(folder)).fit(TWENTY)


def _forget(folder, name):
    config = json.loads((folder / "config.json").read_text())
    (folder / "config.json").write_text(json.dumps({**config, name: None}))


def _shrink(folder):
    tokenizer = json.loads((folder / "tokenizer.json").read_text())
    more = [[f"more {number}", -9.0] for number in range(50)]
    tokenizer["model"]["vocab"] += more
    (folder / "tokenizer.json").write_text(json.dumps(tokenizer))


def test_missing_weights_are_said_and_nothing_is_trained(tmp_path):
    observe = Recorder(tmp_path)
    with pytest.raises(ValueError, match=r"no weights of a/t5.* hf download a/t5"):
        parser_of(encoder="a/t5").fit(TWENTY, (), observe)
    assert not observe.epochs


def test_without_pairs_or_training_it_refuses():
    with pytest.raises(ValueError, match="no training pair"):
        parser_of().fit([])
    with pytest.raises(ValueError, match="has learned nothing yet"):
        parser_of().predict(["hello"])


@pytest.mark.parametrize(
    ("field", "value"), [("decoding", "greedy"), ("steps", 0), ("encoder", " ")]
)
def test_a_configuration_is_checked(field, value):
    with pytest.raises(ValueError, match=field):
        parser_of(**{field: value})


def test_a_bart_is_read_as_it_is_published_without_a_layer_that_writes(tmp_path):
    folder = write_bart(tmp_path / "bart")
    whole, published = (parser_of(encoder=str(folder), steps=1) for _ in range(2))
    whole.fit(TWENTY)
    tensors = load_file(folder / "model.safetensors")
    bare = {name.removeprefix("model."): value for name, value in tensors.items()}
    bare.pop("final_logits_bias", None)
    save_file(bare, folder / "model.safetensors", {"format": "pt"})
    published.fit(TWENTY)
    assert same_weights(published, whole)


def test_a_flan_t5_writes_by_its_own_vectors_before_and_after_it_is_saved(writers, tmp_path):
    published = load_file(writers / "t5" / "model.safetensors")
    parser = parser_of()
    parser._prepare(TWENTY, Recorder(None))
    parser.save(tmp_path)
    for each in (parser, T5.load(tmp_path)):
        network = each._network
        assert network.model.config.scale_decoder_outputs is False
        for name, table in (
            ("shared", network.model.get_input_embeddings()),
            ("lm_head", network.model.get_output_embeddings()),
        ):
            assert torch.equal(table.weight[: network.first].cpu(), published[f"{name}.weight"])
        assert shared_weights(network.model) == {
            "encoder.embed_tokens.weight": "shared.weight",
            "decoder.embed_tokens.weight": "shared.weight",
        }


def test_a_file_without_all_weights_is_refused(tmp_path):
    folder = write_t5(tmp_path / "t5")
    some = load_file(folder / "model.safetensors")
    del some["encoder.final_layer_norm.weight"]
    save_file(some, folder / "model.safetensors", {"format": "pt"})
    with pytest.raises(ValueError, match=r"lacks 1 weights of the network.*final_layer_norm"):
        parser_of(encoder=str(folder)).fit(TWENTY)


def test_atoms_start_from_the_vectors_of_their_words(writers):
    parser = parser_of(encoder="bart", steps=1)
    parser._prepare(TWENTY, Recorder(None))
    network = parser._network
    table = network.model.get_input_embeddings().weight
    [*pieces] = network.tokenizer.encode("location", add_special_tokens=False).ids
    torch.testing.assert_close(table[network.numbers[":<location>"]], table[pieces].mean(0))
    assert network.model.get_output_embeddings().weight is table


def test_equal_seeds_give_equal_weights_and_others_do_not():
    one, other, third = parser_of(3), parser_of(3), parser_of(4)
    for parser in (one, other, third):
        parser.fit(TWENTY)
    assert same_weights(one, other) and not same_weights(one, third)


def test_a_form_of_validation_that_cannot_be_spelled_is_just_wrong(tmp_path):
    observe = Recorder(tmp_path)
    unseen = replace(TWENTY[0], form='( sing " <name> " )')
    parser_of(steps=1).fit(TWENTY, [unseen], observe)
    assert (observe.epochs[-1].validation_loss, observe.epochs[-1].validation_accuracy) == (None, 0)


def test_a_toy_form_is_what_the_tests_take_it_for():
    assert canonical(form("bring", "object", "")) == TWENTY[0].form
