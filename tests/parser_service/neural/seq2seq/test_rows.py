"""The rows of the paper with weights made here, in the formats in which theirs are published."""

from dataclasses import asdict

import pytest
import torch

from annotations.language.texts.errors import Refusal
from parser_service.neural.elmo.row import Seq2SeqGloveElmo
from parser_service.neural.seq2seq.rows import Seq2SeqGlove, Seq2SeqMiniLm
from parser_service.neural.word_vectors.vector_cache import VectorCache
from parser_service.parsers import pretrained_files
from parser_service.parsers.interface import Cancelled, Pair
from parser_service.parsers.registry import parsers
from parser_service.parsers.words import words
from tests.parser_service.neural.conftest import PRETRAINED, Recorder, StoppedOnce, parser_of
from tests.parser_service.neural.tampering import alter_weights
from tests.parser_service.neural.tiny_weights import write_bert

pytestmark = pytest.mark.usefixtures("kept_there")
CONTEXTUAL = [name for name in PRETRAINED if name != "seq2seq-glove"]


def weights(parser):
    return {name: value.cpu() for name, value in parser._model.state_dict().items()}


def same_weights(one, other):
    return all(torch.equal(value, weights(other)[name]) for name, value in weights(one).items())


def test_these_are_the_rows_that_read_pretrained_words():
    assert set(PRETRAINED) == {name for name in parsers() if name.startswith("seq2seq-")}


@pytest.mark.parametrize("name", PRETRAINED)
def test_a_row_trains_and_answers_alike_once_loaded(name, pairs, tmp_path):
    parser, observe = parser_of(name), Recorder(tmp_path / "run")
    parser.fit(pairs[:16], pairs[:3], observe)
    parser.save(tmp_path / "saved")
    loaded = type(parser).load(tmp_path / "saved")
    asked = [*(pair.utterance for pair in pairs[:6]), "", "unheard of", "☃"]
    assert loaded.predict(asked, 2) == parser.predict(asked, 2)
    assert observe.epochs[-1].train_loss < observe.epochs[0].train_loss
    assert loaded.parameters() == parser.parameters() > 0


@pytest.mark.parametrize("name", PRETRAINED)
def test_a_stopped_run_goes_on_to_the_same_weights(name, pairs, tmp_path):
    undisturbed, stopped, resumed = parser_of(name), parser_of(name), parser_of(name)
    observe = StoppedOnce(tmp_path)
    undisturbed.fit(pairs[:10], pairs[10:13])
    with pytest.raises(Cancelled):
        stopped.fit(pairs[:10], pairs[10:13], observe)
    resumed.fit(pairs[:10], pairs[10:13], observe)
    assert any("Resuming after epoch 1" in line for line in observe.lines)
    assert same_weights(undisturbed, resumed) and not same_weights(undisturbed, stopped)


def test_vectors_from_files_train_the_same_parser(pairs, tmp_path, monkeypatch):
    from_memory = parser_of("seq2seq-glove-elmo")
    from_memory.fit(pairs[:9])
    monkeypatch.setattr(VectorCache.__init__, "__defaults__", (None, 0))
    laid_down, taken_up = parser_of("seq2seq-glove-elmo"), parser_of("seq2seq-glove-elmo")
    laid_down.fit(pairs[:9])
    taken_up.fit(pairs[:9])
    assert list((tmp_path / "vectors").rglob("*.safetensors"))
    assert same_weights(from_memory, laid_down) and same_weights(from_memory, taken_up)


def test_the_word_vectors_start_as_gloves_and_are_trained_on(pairs):
    parser = parser_of("seq2seq-glove")
    parser._read_vocabularies(pairs)
    [number] = parser._source.numbers(["bring"])
    start = weights(parser)["encoder.embedding.weight"][number].clone()
    assert torch.equal(start, parser._glove["bring"])
    assert "unused" not in parser._source.words
    parser.fit(pairs)
    assert not torch.equal(start, weights(parser)["encoder.embedding.weight"][number])


def test_a_rare_word_is_known_where_glove_has_it(pairs):
    parser = parser_of("seq2seq-glove", minimum_count=100)
    parser._read_vocabularies(pairs)
    assert parser._source.words == ("a", "bring", "fetch", "the")


@pytest.mark.parametrize("name", CONTEXTUAL)
def test_the_contextual_encoder_stays_as_it_was_published(name, pairs):
    parser = parser_of(name)
    sentence = words(pairs[0].utterance)
    before = parser._context(sentence).clone()
    parser.fit(pairs[:9])
    assert torch.equal(before, parser._open().encoder.vectors(sentence))
    assert not any("transformer" in key or "cnn" in key for key in weights(parser))


def test_the_mix_of_elmos_layers_is_learned(pairs):
    parser = parser_of("seq2seq-glove-elmo")
    parser.fit(pairs[:9])
    assert weights(parser)["encoder.mix.weights"].unique().numel() == 3
    assert weights(parser)["encoder.mix.gamma"] != 1


def test_a_word_is_read_in_its_context(pairs):
    parser = parser_of("seq2seq-minilm", minimum_count=100)  # its own vectors know no word
    parser.fit(pairs[:9])
    one, other = parser.predict(["find the person"])[0], parser.predict(["the room"])[0]
    assert one[0].score != other[0].score


@pytest.mark.parametrize(
    ("name", "changes", "named"),
    [
        ("seq2seq-glove", {"glove": "absent.txt"}, r"absent\.txt.*glove\.6B\.100d\.txt"),
        ("seq2seq-glove-elmo", {"elmo": "absent"}, "absent.*elmo_2x"),
        ("seq2seq-glove-gpt", {"encoder": "a/gpt"}, "hf download a/gpt"),
        ("seq2seq-minilm", {"encoder": "absent"}, r"absent.*config\.json, model\.safetensors"),
    ],
)
def test_missing_weights_are_named_and_nothing_is_trained(name, changes, named, pairs, tmp_path):
    observe = Recorder(tmp_path)
    with pytest.raises(Refusal, match=named) as refused:
        parser_of(name, **changes).fit(pairs, (), observe)
    assert refused.value.code == "requirement_missing"
    assert not observe.epochs


def test_weights_that_are_pickled_are_refused_before_training(pairs, encoders, tmp_path):
    folder = write_bert(tmp_path / "pickled")
    torch.save({"weights": torch.zeros(3)}, folder / "model.safetensors")
    with pytest.raises(Refusal, match=str(folder)) as refused:
        parser_of("seq2seq-minilm", encoder=str(folder)).fit(pairs)
    assert refused.value.code == "pretrained_weights_unreadable"


def test_another_encoder_under_the_same_name_is_refused(pairs, tmp_path, monkeypatch):
    parser = parser_of("seq2seq-minilm")
    parser.fit(pairs[:9])
    parser.save(tmp_path / "saved")
    write_bert(tmp_path / "others" / "bert", seed=5)
    monkeypatch.setattr(pretrained_files, "_encoders", tmp_path / "others")
    with pytest.raises(Refusal) as refused:
        Seq2SeqMiniLm.load(tmp_path / "saved")
    assert refused.value.code == "other_encoder"


def test_a_run_does_not_go_on_with_another_encoder(pairs, tmp_path, monkeypatch):
    observe = Recorder(tmp_path / "run")
    parser_of("seq2seq-minilm").fit(pairs[:9], (), observe)
    write_bert(tmp_path / "others" / "bert", seed=5)
    monkeypatch.setattr(pretrained_files, "_encoders", tmp_path / "others")
    parser_of("seq2seq-minilm").fit(pairs[:9], (), observe)
    assert any("starts from the beginning" in line for line in observe.lines)


def test_a_saved_parser_whose_weights_were_altered_is_refused(pairs, tmp_path):
    parser = parser_of("seq2seq-glove-elmo")
    parser.fit(pairs[:9])
    parser.save(tmp_path)
    alter_weights(tmp_path)
    with pytest.raises(Refusal) as refused:
        Seq2SeqGloveElmo.load(tmp_path)
    assert refused.value.code == "saved_file_altered"


def test_a_parser_with_glove_is_loaded_without_gloves_file(pairs, tmp_path, monkeypatch):
    parser = parser_of("seq2seq-glove")
    parser.fit(pairs[:9])
    parser.save(tmp_path / "saved")
    monkeypatch.setattr(pretrained_files, "_encoders", tmp_path)
    loaded = Seq2SeqGlove.load(tmp_path / "saved")
    assert loaded.predict(["bring it"]) == parser.predict(["bring it"])


def test_equal_seeds_give_equal_weights(pairs):
    one, other = parser_of("seq2seq-glove-gpt", seed=3), parser_of("seq2seq-glove-gpt", seed=3)
    one.fit(pairs[:9], pairs[9:12])
    torch.rand(17)
    other.fit(pairs[:9], pairs[9:12])
    assert same_weights(one, other)


@pytest.mark.parametrize("name", PRETRAINED)
def test_a_row_is_never_without_its_vectors(name):
    for field in {"glove", "elmo", "encoder"} & asdict(parser_of(name).config).keys():
        with pytest.raises(Refusal, match=rf"\b{field}\b") as refused:
            parser_of(name, **{field: " "})
        assert refused.value.code == "hyperparameter_missing"


def test_commands_without_words_are_trained_on(pairs):
    parser = parser_of("seq2seq-minilm")
    parser.fit([*pairs[:5], Pair("?!", pairs[0].form)])
    assert parser.predict(["?!"])
