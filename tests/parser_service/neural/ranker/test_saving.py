"""Saved, loaded, tampered with, moved."""

import subprocess
import sys
from dataclasses import replace

import pytest
import torch

from annotations.language.texts.errors import Refusal
from parser_service.neural.ranker.form_ranker import FORMS, SAVED, FormRanker
from parser_service.neural.sentence_encoder import SentenceEncoder
from parser_service.neural.sentence_encoder.half_precision import rounded
from parser_service.parsers.interface import Knowledge
from parser_service.parsers.storage import read_json, seal, write_json
from tests.parser_service.neural.conftest import Recorder
from tests.parser_service.neural.fake_device import CPU, FAKE, computing_on
from tests.parser_service.neural.ranker.sample_domain import domain, utterances, weights
from tests.parser_service.neural.tampering import alter_weights, pickle_weights

GPU = pytest.param(
    torch.device("cuda"),
    marks=pytest.mark.skipif(not torch.cuda.is_available(), reason="there is no GPU"),
)
PROCESSORS = [FAKE, GPU]
CAN_PACK = "fbgemm" in torch.backends.quantized.supported_engines


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


def test_saved_and_loaded_it_answers_alike(learned, pairs, tmp_path):
    learned.save(tmp_path / "parser")
    loaded = FormRanker.load(tmp_path / "parser")
    asked = [*utterances(pairs), "", "unheard of", "?!"]
    assert loaded.predict(asked, 3) == learned.predict(asked, 3)
    assert loaded.parameters() == learned.parameters() > 0
    assert (loaded.config, loaded.seed) == (learned.config, learned.seed)


def test_trained_and_loaded_it_answers_from_weights_of_16_bits(learned, tmp_path):
    """Where torch can; they are the numbers that are saved and that whole batches are answered from."""
    learned.save(tmp_path)
    loaded = FormRanker.load(tmp_path)
    for parser in (learned, loaded):
        layers = parser._model.encoder.model.encoder.layer
        dense = [each.output.dense for each in layers]
        assert all(torch.equal(rounded(each.weight), each.weight) for each in dense)
        ready = [*dense, *(each.attention.self for each in layers)]
        assert {each._packed is not None for each in ready} == {CAN_PACK}


def test_a_parser_of_version_10_answers_as_it_did(learned, pairs, tmp_path):
    """Its weights have digits that 16 bits would lose."""
    learned.save(tmp_path / "now")
    older = FormRanker.load(tmp_path / "now")
    older.version = 10
    layer = older._model.encoder.model.encoder.layer[0].output.dense
    with torch.no_grad():
        layer.weight.mul_(1.0001)
    layer._packed = None
    older.save(tmp_path / "before")
    loaded = FormRanker.load(tmp_path / "before")
    assert loaded._model.encoder.model.encoder.layer[0].output.dense._packed is None
    assert loaded.predict(utterances(pairs), 3) == older.predict(utterances(pairs), 3)


def test_a_parser_of_the_domain_is_loaded_with_an_ontology(config, pairs, tmp_path):
    parser = FormRanker(replace(config, steps=4), 0, domain())
    parser.fit(pairs)
    parser.save(tmp_path)
    with pytest.raises(Refusal) as refused:
        FormRanker.load(tmp_path)
    assert refused.value.code == "ontology_missing"
    asked = ["bring the apple", "find the <name> in the kitchen"]
    assert FormRanker.load(tmp_path, domain()).predict(asked) == parser.predict(asked)


def test_an_altered_file_is_refused(learned, tmp_path):
    learned.save(tmp_path)
    alter_weights(tmp_path)
    with pytest.raises(Refusal) as refused:
        FormRanker.load(tmp_path)
    assert refused.value.code == "saved_file_altered"


def test_a_pickle_under_a_safe_name_is_refused_even_with_its_hash(learned, tmp_path):
    learned.save(tmp_path)
    pickle_weights(tmp_path, weights(learned))
    with pytest.raises(Refusal) as refused:
        FormRanker.load(tmp_path)
    assert refused.value.code == "saved_parser_unreadable"


def test_nothing_is_pickled(config, pairs, tmp_path):
    observe = Recorder(tmp_path)
    FormRanker(replace(config, steps=2)).fit(pairs[:9], pairs[9:12], observe)
    names = {path.name for path in observe.last_checkpoint().iterdir()}
    assert {name.rsplit(".")[-1] for name in names} == {"json", "safetensors"}


def test_saved_with_the_network_of_transformers_it_is_the_same_files(learned, tmp_path):
    """Rankers were trained and saved with that network until this project had its own."""
    from transformers import BertConfig, BertModel

    learned.save(tmp_path / "now")
    encoder = learned._model.encoder
    network = BertModel(BertConfig(**encoder.description))
    network.load_state_dict(encoder.model.state_dict())
    earlier = FormRanker.load(tmp_path / "now")
    earlier._model.encoder.model = network
    earlier.save(tmp_path / "before")
    for path in (tmp_path / "now").iterdir():
        assert path.read_bytes() == (tmp_path / "before" / path.name).read_bytes()


def test_a_loaded_ranker_answers_without_importing_transformers(learned, tmp_path):
    learned.save(tmp_path)
    code = (
        "import pathlib, sys; from parser_service.neural.ranker.form_ranker import FormRanker;"
        f"FormRanker.load(pathlib.Path({str(tmp_path)!r})).predict(['bring the apple']);"
        "print(*{'transformers', 'torch._dynamo', 'pandas'} & {*sys.modules})"
    )
    loading = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert (loading.stdout, loading.returncode) == ("\n", 0), loading.stderr


def test_a_loaded_ranker_encodes_the_utterance_and_nothing_else(learned, tmp_path, monkeypatch):
    learned.save(tmp_path)
    encoded = []
    forward = SentenceEncoder.forward
    monkeypatch.setattr(
        SentenceEncoder,
        "forward",
        lambda self, texts, *rest: encoded.extend(texts) or forward(self, texts, *rest),
    )
    FormRanker.load(tmp_path).predict(["bring the apple"])
    assert encoded == ["bring the apple"]


def test_a_parser_saved_without_the_origins_of_its_forms_answers_alike(learned, pairs, tmp_path):
    learned.save(tmp_path)
    about = read_json(tmp_path / FORMS)
    del about["ranked"]["origins"]
    write_json(tmp_path / FORMS, about)
    seal(tmp_path, learned, SAVED)
    older = FormRanker.load(tmp_path).predict(utterances(pairs), 10_000)
    assert older == learned.predict(utterances(pairs), 10_000)
    assert {each.origin for each in older[0]} == {"training", ""}
