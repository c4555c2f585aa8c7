"""How published weights are read, and which files are refused."""

import json

import pytest
import torch
from safetensors.torch import load_file, save_file

from annotations.language.texts.errors import Refusal
from parser_service.neural.t5.network import shared_weights
from parser_service.neural.t5.t5_parser import T5
from tests.parser_service.neural.conftest import Recorder
from tests.parser_service.neural.t5.conftest import TWENTY, parser_of
from tests.parser_service.neural.t5.weights import same_weights
from tests.parser_service.neural.tiny_encoder_decoder import write_bart, write_t5
from tests.parser_service.neural.tiny_weights import write_bert

pytestmark = pytest.mark.usefixtures("kept_there")

MISSING, UNREADABLE = "requirement_missing", "pretrained_weights_unreadable"
START = "decoder_start_token_id"


def test_pickled_weights_are_refused_before_training(tmp_path):
    folder = write_t5(tmp_path / "pickled")
    state = {"weights": torch.zeros(3)}
    torch.save(state, folder / "model.safetensors")
    with pytest.raises(Refusal, match=str(folder)) as refused:
        parser_of(encoder=str(folder)).fit(TWENTY)
    assert refused.value.code == "pretrained_weights_unreadable"
    (folder / "model.safetensors").rename(folder / "pytorch_model.bin")
    with pytest.raises(Refusal, match="pickled") as refused:
        parser_of(encoder=str(folder)).fit(TWENTY)
    assert refused.value.code == "requirement_missing"


def test_code_that_comes_with_weights_is_not_run(tmp_path):
    folder = write_bart(tmp_path / "coded")
    config = json.loads((folder / "config.json").read_text())
    maps = {"AutoConfig": "code.Config", "AutoModelForSeq2SeqLM": "code.Model"}
    (folder / "config.json").write_text(json.dumps({**config, "model_type": "x", "auto_map": maps}))
    (folder / "code.py").write_text(f"open({str(tmp_path / 'ran')!r}, 'w')")
    with pytest.raises(Refusal, match=str(folder)) as refused:
        parser_of(encoder=str(folder)).fit(TWENTY)
    assert refused.value.code == "pretrained_weights_unreadable"
    assert not (tmp_path / "ran").exists()


@pytest.mark.parametrize(
    ("change", "code", "named"),
    [
        (lambda folder: (folder / "tokenizer.json").unlink(), MISSING, "tokenizer.json"),
        (lambda folder: write_bert(folder), UNREADABLE, "wrong"),
        (lambda folder: _forget(folder, START), UNREADABLE, START),
        (lambda folder: _shrink(folder), UNREADABLE, "tokenizer"),
    ],
)
def test_files_that_do_not_make_an_encoder_decoder_are_refused(change, code, named, tmp_path):
    folder = write_t5(tmp_path / "wrong")
    change(folder)
    with pytest.raises(Refusal, match=named) as refused:
        parser_of(encoder=str(folder)).fit(TWENTY)
    assert refused.value.code == code


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
    with pytest.raises(Refusal, match="hf download a/t5") as refused:
        parser_of(encoder="a/t5").fit(TWENTY, (), observe)
    assert refused.value.code == "requirement_missing"
    assert not observe.epochs


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
    with pytest.raises(Refusal, match=r"\b1\b.*final_layer_norm") as refused:
        parser_of(encoder=str(folder)).fit(TWENTY)
    assert refused.value.code == "pretrained_weights_unreadable"


def test_atoms_start_from_the_vectors_of_their_words(writers):
    parser = parser_of(encoder="bart", steps=1)
    parser._prepare(TWENTY, Recorder(None))
    network = parser._network
    table = network.model.get_input_embeddings().weight
    [*pieces] = network.tokenizer.encode("location", add_special_tokens=False).ids
    torch.testing.assert_close(table[network.numbers[":<location>"]], table[pieces].mean(0))
    assert network.model.get_output_embeddings().weight is table
