import subprocess
import sys
from dataclasses import dataclass

import pytest

from annotations.language.texts.errors import Refusal
from parser_service.neural.elmo.config import ElmoFiles, find_elmo
from parser_service.parsers import pretrained_files
from parser_service.parsers.hyperparameters.fields import hyperparameter
from parser_service.parsers.pretrained_files import (
    find_encoder,
    find_glove,
    missing_weights,
    refuse_missing_weights,
)
from parser_service.parsers.registry import make_config


@dataclass
class Names:
    glove: str = hyperparameter("", "", finds=find_glove)
    elmo: str = hyperparameter("", "", finds=find_elmo)
    encoder: str = hyperparameter("", "", finds=find_encoder)


@pytest.fixture
def encoders(tmp_path):
    """A folder with a gzipped GloVe, an ELMo and a transformer; which bytes they have is no matter."""
    (tmp_path / "vectors.txt.gz").touch()
    for name in ("elmo/x_options.json", "elmo/x_weights.hdf5"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).touch()
    for name in ("config.json", "model.safetensors", "tokenizer.json"):
        (tmp_path / "makers" / "bert" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "makers" / "bert" / name).touch()
    return tmp_path


def test_what_is_there_is_found(encoders):
    elmo = encoders / "elmo"
    assert find_glove("vectors.txt", encoders) == encoders / "vectors.txt.gz"
    assert find_glove(str(encoders / "vectors.txt.gz")) == encoders / "vectors.txt.gz"
    assert find_elmo("elmo", encoders) == ElmoFiles(
        elmo / "x_options.json", elmo / "x_weights.hdf5"
    )
    assert find_elmo(str(elmo)) == find_elmo("elmo", encoders)


def test_nothing_is_missing_where_all_is_there(encoders):
    assert missing_weights(Names("vectors.txt", "elmo", "makers/bert"), encoders) is None
    assert missing_weights(Names(), encoders) is None
    assert missing_weights(make_config("linear"), encoders) is None


def test_a_missing_file_says_what_to_put_where(encoders):
    sentence = missing_weights(Names(glove="glove.6B.100d.txt"), encoders)
    for named in ("glove.6B.100d.txt.gz", "glove.6B.zip", "nlp.stanford.edu/projects/glove"):
        assert named in sentence
    assert f" {encoders}/glove.6B.100d.txt" in sentence


def test_all_that_is_missing_is_said_at_once(encoders):
    sentence = missing_weights(Names("no.txt", "no_elmo", "nobody/no_bert"), encoders)
    assert all(name in sentence for name in ("no.txt", "no_elmo", "nobody/no_bert"))
    assert f"hf download nobody/no_bert --local-dir {encoders}/nobody/no_bert" in sentence


@pytest.mark.parametrize("name", ["another_weights.hdf5", "another_options.json"])
def test_an_elmo_with_two_files_of_a_kind_is_not_guessed(encoders, name):
    (encoders / "elmo" / name).touch()
    with pytest.raises(Refusal, match=f"{encoders}/elmo") as refused:
        find_elmo("elmo", encoders)
    assert refused.value.code == "pretrained_weights_missing"


def test_the_installations_folder_is_looked_in(encoders, monkeypatch):
    names = Names(encoder="makers/bert")
    monkeypatch.setattr(pretrained_files, "_encoders", None)
    with pytest.raises(Refusal, match="makers/bert") as refused:
        refuse_missing_weights(names)
    assert refused.value.code == "requirement_missing"
    monkeypatch.setattr(pretrained_files, "_encoders", encoders)
    refuse_missing_weights(names)


def test_half_a_transformer_is_said(encoders):
    (encoders / "makers" / "bert" / "model.safetensors").rename(encoders / "makers/bert/x.bin")
    assert "pickled" in missing_weights(Names(encoder="makers/bert"), encoders)


@pytest.mark.parametrize("row", ["elmo", "gpt", "bert-base", "bert-large"])
def test_a_row_of_the_paper_names_all_its_weights(row, tmp_path):
    sentence = missing_weights(make_config(f"seq2seq-glove-{row}"), tmp_path)
    assert "GloVe" in sentence and row.partition("-")[0] in sentence


def test_looking_for_weights_loads_no_torch():
    code = (
        "import sys; from parser_service.parsers.registry import parsers, make_config\n"
        "from parser_service.parsers.pretrained_files import missing_weights\n"
        "for name in parsers(): missing_weights(make_config(name))\n"
        "sys.exit('torch' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


THERE = {"glove": "vectors.txt", "elmo": "elmo", "encoder": "makers/bert"}


@pytest.mark.parametrize("field", THERE)
def test_a_request_names_no_path_and_learns_nothing_of_it(encoders, field):
    for there in (f"../{THERE[field]}", str(encoders / THERE[field])):
        for name in (there, there + "x", "a/../../b", "a\0b"):
            sentence = missing_weights(Names(**{field: name}), encoders / "inner", anywhere=False)
            assert sentence == (
                f"{field} is {name!r}, but a request may only name what is in GPSR_ENCODERS_DIR. "
                "Put the weights there and give their name without a path."
            )


def test_a_request_looks_in_the_folder_of_encoders_alone(encoders, tmp_path, monkeypatch):
    monkeypatch.chdir(encoders)
    names = Names("vectors.txt", "elmo", "makers/bert")
    assert missing_weights(names, encoders, anywhere=False) is None
    elsewhere = tmp_path / "other"
    assert missing_weights(names, elsewhere) is None
    sentence = missing_weights(names, elsewhere, anywhere=False)
    assert all(each in sentence for each in ("vectors.txt", "elmo", "makers/bert"))


def test_a_request_names_a_listed_package_and_no_other(encoders, monkeypatch):
    package = encoders / "packages" / "tiny_weights"
    package.mkdir(parents=True)
    for name in ("__init__.py", "config.json", "model.safetensors", "tokenizer.json"):
        (package / name).touch()
    monkeypatch.syspath_prepend(package.parent)
    names = Names(encoder="tiny_weights")
    assert missing_weights(names, encoders) is None
    assert "list it in GPSR_ENCODER_PACKAGES" in missing_weights(names, encoders, anywhere=False)
    monkeypatch.setattr(pretrained_files, "_packages", frozenset({"tiny_weights"}))
    assert missing_weights(names, encoders, anywhere=False) is None


def test_the_installations_folder_comes_before_the_working_directory(encoders, monkeypatch):
    here = encoders / "here"
    here.mkdir()
    (here / "vectors.txt").touch()
    monkeypatch.chdir(here)
    assert find_glove("vectors.txt", encoders) == encoders / "vectors.txt.gz"
