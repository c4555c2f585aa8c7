from dataclasses import replace
from math import exp, log

import pytest
import torch

from annotations.language.logic import read_form
from annotations.language.ontology import Entity, Ontology
from annotations.language.predicates import infer_signatures
from parser_service.neural.checkpoints import WEIGHTS
from parser_service.neural.pretrained import load_encoder
from parser_service.neural.ranker import VALIDATIONS, FormRanker, is_due
from parser_service.neural.ranker_training import RankerTraining
from parser_service.parsers.candidates.glosses import glosses
from parser_service.parsers.interface import Cancelled, Knowledge, Pair
from parser_service.parsers.ranker_config import RankerConfig
from parser_service.parsers.storage import CONFIG, file_hash, read_json, write_json
from tests.parser_service.neural.conftest import Recorder, form, toy_pairs
from tests.parser_service.neural.elsewhere import CPU, ELSEWHERE, computing_on
from tests.parser_service.neural.tiny_encoder import write_tiny_encoder

GPU = pytest.param(
    torch.device("cuda"),
    marks=pytest.mark.skipif(not torch.cuda.is_available(), reason="there is no GPU"),
)
PROCESSORS = [ELSEWHERE, GPU]
EXTRA = "bring find is_a name at with given from apple jam kitchen sink Ann who one that is"
UNSEEN = form("find", "object", " in the <location>")
HOME = Ontology(
    (
        Entity("object", "apple"),
        Entity("object", "jam"),
        Entity("room", "kitchen"),
        Entity("location", "sink"),
        Entity("name", "Ann"),
    )
)


@pytest.fixture(scope="module")
def config(tmp_path_factory):
    said = {pair.utterance for pair in toy_pairs()} | {pair.form for pair in toy_pairs()} | {EXTRA}
    folder = tmp_path_factory.mktemp("encoders") / "tiny"
    forms = sorted({pair.form for pair in toy_pairs()})
    words = {piece for text in [*said, *glosses(forms, None)] for piece in text.split()}
    write_tiny_encoder(folder, words | {"object", "room", "location", "<", ">", ",", "look"})
    return RankerConfig(
        encoder=str(folder),
        steps=30,
        batch_size=8,
        learning_rate=1e-3,
        head_learning_rate=5e-2,
        averaging=0.9,
        pretrained_share=0.0,
        pretrained_share_domain=0.0,
        threads=1,
    )


@pytest.fixture(scope="module")
def learned(config, pairs):
    """A ranker that has seen every pair but those of one form."""
    parser = FormRanker(replace(config, steps=150), seed=1)
    parser.fit([pair for pair in pairs if pair.form != UNSEEN], pairs)
    return parser


def domain() -> Knowledge:
    forms = [read_form(pair.form) for pair in toy_pairs()]
    return Knowledge(infer_signatures(forms), HOME)


def weights(parser):
    return parser._model.state_dict()


def same_weights(one, other):
    return all(torch.equal(value, weights(other)[name]) for name, value in weights(one).items())


def utterances(pairs):
    return [pair.utterance for pair in pairs]


def accuracy(parser, pairs):
    answers = parser.predict(utterances(pairs))
    right = (a[0].form == p.form for a, p in zip(answers, pairs, strict=True))
    return sum(right) / len(pairs)


def test_it_learns_a_toy_language(learned, pairs):
    assert accuracy(learned, [pair for pair in pairs if pair.form != UNSEEN]) >= 0.9


def test_a_form_that_no_pair_has_is_among_the_answers(learned, pairs):
    [asked] = {
        pair.utterance
        for pair in pairs
        if pair.form == UNSEEN and " a " in pair.utterance and "look" in pair.utterance
    }
    assert UNSEEN in [candidate.form for candidate in learned.predict([asked], 30)[0]]


def test_scores_are_log_probabilities_that_sum_to_one(learned, pairs):
    for candidates in learned.predict(utterances(pairs)[:5], 10_000):
        scores = [candidate.score for candidate in candidates]
        assert scores == sorted(scores, reverse=True)
        assert sum(map(exp, scores)) == pytest.approx(1, abs=1e-3)
        assert len({candidate.form for candidate in candidates}) == len(candidates)


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


@pytest.mark.parametrize("checks", [3, 25, 45])
def test_a_stopped_run_goes_on_to_the_same_weights_and_predictions(config, pairs, tmp_path, checks):
    train, validation = pairs[:18], pairs[18:]
    undisturbed = FormRanker(config, seed=5, knowledge=domain())
    undisturbed.fit(train, validation, Recorder(tmp_path / "undisturbed"))
    stopped = Recorder(tmp_path / "run", stop_after_checks=checks)
    with pytest.raises(Cancelled):
        FormRanker(config, seed=5, knowledge=domain()).fit(train, validation, stopped)
    resumed, observe = FormRanker(config, seed=5, knowledge=domain()), Recorder(tmp_path / "run")
    resumed.fit(train, validation, observe)
    assert same_weights(undisturbed, resumed)
    assert resumed.predict(utterances(pairs), 3) == undisturbed.predict(utterances(pairs), 3)
    epochs = [report.epoch for report in stopped.epochs + observe.epochs]
    assert epochs == list(range(1, len(epochs) + 1))


def test_an_unreadable_checkpoint_is_said_and_training_starts_again(config, pairs, tmp_path):
    with pytest.raises(Cancelled):
        FormRanker(config, 5).fit(pairs, pairs[:4], Recorder(tmp_path, stop_after_checks=30))
    (tmp_path / "last" / "training.safetensors").write_bytes(b"torn")
    undisturbed, resumed, observe = FormRanker(config, 5), FormRanker(config, 5), None
    undisturbed.fit(pairs, pairs[:4])
    observe = Recorder(tmp_path)
    resumed.fit(pairs, pairs[:4], observe)
    assert any("Training starts again from the beginning" in line for line in observe.lines)
    assert same_weights(undisturbed, resumed)


def test_the_last_checkpoint_has_the_weights_of_the_parser(config, pairs, tmp_path):
    parser, observe = FormRanker(config, seed=5), Recorder(tmp_path)
    parser.fit(pairs[:18], pairs[18:], observe)
    kept = weights(FormRanker.load(observe.best_checkpoint()))
    # Where the examples lie may have been computed in bf16 for the checkpoint.
    learned = [name for name in kept if name != "nearest.vectors"]
    assert all(torch.equal(weights(parser)[name], kept[name]) for name in learned)


def test_every_epoch_is_reported(config, pairs, tmp_path):
    observe = Recorder(tmp_path)
    FormRanker(config, seed=1).fit(pairs, pairs[:4], observe)
    first, last = observe.epochs[0], observe.epochs[-1]
    assert last.train_loss < first.train_loss
    assert first.seconds > 0
    assert len(observe.epochs) == -(-config.steps // -(-len(pairs) // config.batch_size))
    assert observe.fractions[-1] == 1
    assert "forms of the training pairs" in observe.lines[0]


def test_the_validation_pairs_are_asked_now_and_then_and_at_the_end(config, pairs, tmp_path):
    observe = Recorder(tmp_path)
    FormRanker(config, seed=1).fit(pairs, pairs[:4], observe)
    asked = [report for report in observe.epochs if report.validation_accuracy is not None]
    assert len(asked) == VALIDATIONS < len(observe.epochs)
    assert asked[-1] is observe.epochs[-1]
    assert all(0 <= report.validation_accuracy <= 1 for report in asked)


@pytest.mark.parametrize("epochs", [1, 2, 3])
def test_a_short_training_asks_after_every_epoch(epochs):
    assert all(is_due(epoch, epochs) for epoch in range(1, epochs + 1))


def test_without_validation_pairs_it_learns_all_the_same(config, pairs, tmp_path):
    observe = Recorder(tmp_path)
    FormRanker(config, seed=1).fit(pairs, (), observe)
    assert observe.epochs[-1].validation_accuracy is None


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
    FormRanker(replace(config, steps=40), 0, knowledge).fit(pairs)
    return set(seen)


def test_in_the_domain_training_reads_utterances_with_other_entities(config, pairs, monkeypatch):
    spoken = Pair("bring the apple to me", pairs[0].form, "paraphrased")
    generated = Pair("please fetch the <object>", pairs[0].form, "generated")
    seen = texts_of_a_training([*pairs, spoken, generated], domain(), config, monkeypatch)
    assert {text for text in seen if text.endswith("to me")} == {
        "bring the apple to me",
        "bring the jam to me",
    }
    assert {text for text in seen if text.startswith("please fetch")} == {
        "please fetch the <object>",
        "please fetch the apple",
        "please fetch the jam",
    }


def test_strictly_it_reads_them_as_they_are(config, pairs, monkeypatch):
    spoken = Pair("bring the apple to me", pairs[0].form, "paraphrased")
    seen = texts_of_a_training([*pairs, spoken], Knowledge(), config, monkeypatch)
    assert seen == {pair.utterance for pair in [*pairs, spoken]}


def test_a_closed_set_answers_forms_of_the_training_pairs_alone(config, pairs):
    parser = FormRanker(replace(config, forms="closed", steps=4))
    parser.fit(pairs[:9], pairs[9:])
    known = {pair.form for pair in pairs[:9]}
    assert {each.form for each in parser.predict(["find it"], 999)[0]} == known


def test_below_the_threshold_the_answer_is_unknown(learned, pairs):
    hesitant = FormRanker(replace(learned.config, unknown_below=0.9999), seed=1)
    hesitant._ranked, hesitant._decision = learned._ranked, learned._decision
    hesitant._model = learned._model
    [[first, second]] = hesitant.predict(["something else"], 2)
    assert (first.form, first.score) == ("UNKNOWN", log(0.9999))
    assert second == learned.predict(["something else"])[0][0]
    assert learned.predict(["something else"])[0][0].form != "UNKNOWN"


def test_saved_and_loaded_it_answers_alike(learned, pairs, tmp_path):
    learned.save(tmp_path / "parser")
    loaded = FormRanker.load(tmp_path / "parser")
    asked = [*utterances(pairs), "", "unheard of", "?!"]
    assert loaded.predict(asked, 3) == learned.predict(asked, 3)
    assert loaded.parameters() == learned.parameters() > 0
    assert (loaded.config, loaded.seed) == (learned.config, learned.seed)


def test_a_parser_of_the_domain_is_loaded_with_an_ontology(config, pairs, tmp_path):
    parser = FormRanker(replace(config, steps=4), 0, domain())
    parser.fit(pairs)
    parser.save(tmp_path)
    with pytest.raises(ValueError, match="Load it with the ontology of its world"):
        FormRanker.load(tmp_path)
    asked = ["bring the apple", "find the <name> in the kitchen"]
    assert FormRanker.load(tmp_path, domain()).predict(asked) == parser.predict(asked)


def test_an_altered_file_is_refused(learned, tmp_path):
    learned.save(tmp_path)
    content = bytearray((tmp_path / WEIGHTS).read_bytes())
    content[-1] ^= 1
    (tmp_path / WEIGHTS).write_bytes(content)
    with pytest.raises(ValueError, match=r"model\.safetensors is not the file that was saved"):
        FormRanker.load(tmp_path)


def test_a_pickle_under_a_safe_name_is_refused_even_with_its_hash(learned, tmp_path):
    learned.save(tmp_path)
    torch.save(weights(learned), tmp_path / WEIGHTS)
    about = read_json(tmp_path / CONFIG)
    about["sha256"][WEIGHTS] = file_hash(tmp_path / WEIGHTS)
    write_json(tmp_path / CONFIG, about)
    with pytest.raises(ValueError, match="is not a safetensors file, and no other kind is read"):
        FormRanker.load(tmp_path)


def test_nothing_is_pickled(config, pairs, tmp_path):
    observe = Recorder(tmp_path)
    FormRanker(replace(config, steps=2)).fit(pairs[:9], pairs[9:12], observe)
    names = {path.name for path in observe.last_checkpoint().iterdir()}
    assert {name.rsplit(".")[-1] for name in names} == {"json", "safetensors"}


def test_a_cancelled_prediction_stops(learned):
    def cancel():
        raise Cancelled

    with pytest.raises(Cancelled):
        learned.predict(["bring the <object>"], check=cancel)


def test_the_first_candidate_does_not_depend_on_how_many_are_asked_for(learned, pairs):
    one, three = learned.predict(utterances(pairs), 1), learned.predict(utterances(pairs), 3)
    assert [a[0] for a in one] == [a[0] for a in three]


def test_the_order_of_the_questions_changes_no_answer(learned, pairs):
    asked = utterances(pairs)
    forward, backward = learned.predict(asked), learned.predict(asked[::-1])[::-1]
    assert [a[0].form for a in forward] == [a[0].form for a in backward]


def test_nothing_asked_nothing_answered(learned):
    assert learned.predict([]) == []


def test_without_training_pairs_it_refuses(config):
    with pytest.raises(ValueError, match="no training pair"):
        FormRanker(config).fit([])


def test_asked_before_it_has_learned_it_says_so(config):
    with pytest.raises(ValueError, match="has learned nothing yet"):
        FormRanker(config).predict(["go"])


def test_a_missing_encoder_is_said_before_training(config, pairs, tmp_path, monkeypatch):
    monkeypatch.setattr("parser_service.neural.ranker.encoders_folder", lambda: tmp_path)
    with pytest.raises(
        ValueError, match=rf"no weights of absent.*Put its .* into {tmp_path}/absent"
    ):
        FormRanker(replace(config, encoder="absent")).fit(pairs)


def test_a_learning_rate_that_diverges_is_said(config, pairs, monkeypatch):
    monkeypatch.setattr(RankerTraining, "_train_on", lambda *_: float("nan"))
    with pytest.raises(ValueError, match=r"Training diverged in epoch 1.*learning rate below"):
        FormRanker(config).fit(pairs)


@pytest.mark.parametrize(("forms", "is_open"), [("open", True), ("closed", False)])
@pytest.mark.parametrize("asked", [5, 0], ids=["calibrated", "without validation"])
def test_new_forms_are_candidates_unless_the_set_is_closed(config, pairs, forms, is_open, asked):
    parser = FormRanker(replace(config, forms=forms, steps=1))
    parser.fit(pairs, pairs[:asked])
    answers = parser.predict(["find it"], 999)[0]
    known = {pair.form for pair in pairs}
    assert ({each.form for each in answers} > known) is is_open


@pytest.mark.parametrize("asked", [True, False], ids=["calibrated", "without validation"])
def test_known_forms_are_answered_where_validation_and_training_have_no_others(
    config, pairs, asked
):
    parser = FormRanker(config, seed=1)
    parser.fit(pairs, pairs if asked else [])
    known = {pair.form for pair in pairs}
    assert all(ranked[0].form in known for ranked in parser.predict(utterances(pairs)))


def test_new_forms_are_answered_where_validation_has_no_others(config, pairs):
    parser = FormRanker(config, seed=1)
    known = [pair for pair in pairs if pair.form != UNSEEN]
    unseen = [pair for pair in pairs if pair.form == UNSEEN]
    parser.fit(known, unseen)
    answers = parser.predict(utterances(unseen))
    assert not {ranked[0].form for ranked in answers} & {pair.form for pair in known}


def test_the_encoder_goes_back_to_the_pretrained_one_as_far_as_the_protocol_says(config, pairs):
    whole = replace(config, steps=2, pretrained_share=0.5, pretrained_share_domain=1.0)
    strict, domestic = FormRanker(whole), FormRanker(whole, knowledge=domain())
    pretrained = load_encoder(config.encoder).model.state_dict()
    for parser in (strict, domestic):
        parser.fit(pairs)
    name = "encoder.layer.0.output.dense.weight"
    assert torch.equal(weights(domestic)[f"encoder.model.{name}"], pretrained[name])
    assert not torch.equal(weights(strict)[f"encoder.model.{name}"], pretrained[name])


@pytest.mark.parametrize("device", PROCESSORS, ids=str)
@pytest.mark.filterwarnings("ignore:for .* copying from a non-meta parameter")
@pytest.mark.parametrize("knowledge", [Knowledge(), domain()], ids=["strict", "domain"])
def test_a_ranker_trained_elsewhere_answers_alike_on_the_cpu(
    knowledge, device, config, pairs, tmp_path
):
    asked = utterances(pairs)
    with computing_on(device):
        parser = FormRanker(replace(config, precision="fp32"), seed=1, knowledge=knowledge)
        parser.fit(pairs[:18], pairs[18:], Recorder(tmp_path / "run"))
        assert {weight.device.type for _, weight in parser._model.trained()} == {device.type}
        there = parser.predict(asked, 2)
        parser.save(tmp_path / "saved")
    with computing_on(CPU):
        here = FormRanker.load(tmp_path / "saved", knowledge).predict(asked, 2)
    assert [[each.form for each in ranked] for ranked in here] == [
        [each.form for each in ranked] for ranked in there
    ]
