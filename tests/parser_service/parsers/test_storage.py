import json

import pytest

from annotations.language.texts.errors import Refusal
from parser_service.parsers.interface import Pair
from parser_service.parsers.knn import NearestNeighbour
from parser_service.parsers.nearest_pairs import PAIRS
from parser_service.parsers.storage import CONFIG


@pytest.fixture
def folder(tmp_path):
    parser = NearestNeighbour(seed=7)
    parser.fit([Pair("go to the kitchen", '( go " <room> " )')])
    parser.save(tmp_path)
    return tmp_path


def rewrite(path, **changes):
    path.write_text(json.dumps(json.loads(path.read_text()) | changes))


def test_configuration_and_seed_come_back(folder):
    parser = NearestNeighbour.load(folder)
    assert (parser.seed, parser.config) == (7, NearestNeighbour.Config())


def test_saving_again_gives_the_same_bytes(folder, tmp_path_factory):
    other = tmp_path_factory.mktemp("other")
    NearestNeighbour.load(folder).save(other)
    for name in (CONFIG, PAIRS):
        assert (folder / name).read_bytes() == (other / name).read_bytes()


def test_an_altered_file_is_refused(folder):
    (folder / PAIRS).write_text((folder / PAIRS).read_text().replace("kitchen", "bedroom"))
    with pytest.raises(Refusal, match=PAIRS) as refused:
        NearestNeighbour.load(folder)
    assert refused.value.code == "saved_file_altered"


@pytest.mark.parametrize(
    "written", [b"[" * 100_000, b'{"a":' * 100_000, b"\xff", b"", b"[]"], ids=len
)
def test_a_configuration_that_nobody_wrote_is_refused(written, folder):
    (folder / CONFIG).write_bytes(written)
    with pytest.raises(Refusal, match=CONFIG) as refused:
        NearestNeighbour.load(folder)
    assert refused.value.code == "saved_parser_unreadable"


def test_a_missing_file_is_refused(folder):
    (folder / PAIRS).unlink()
    with pytest.raises(Refusal, match=PAIRS) as refused:
        NearestNeighbour.load(folder)
    assert refused.value.code == "saved_file_missing"


def test_an_empty_folder_is_refused(tmp_path):
    with pytest.raises(Refusal, match=CONFIG) as refused:
        NearestNeighbour.load(tmp_path)
    assert refused.value.code == "saved_file_missing"


@pytest.mark.parametrize("content", [b"\x80\x04\x95", b"not json", b"[]", b"{}"])
def test_a_config_that_describes_no_parser_is_refused(folder, content):
    (folder / CONFIG).write_bytes(content)
    with pytest.raises(Refusal, match=CONFIG) as refused:
        NearestNeighbour.load(folder)
    assert refused.value.code == "saved_parser_unreadable"


def test_another_parser_or_version_is_refused(folder):
    rewrite(folder / CONFIG, version=99)
    with pytest.raises(Refusal, match=r"\b99 of knn.*\b1 of knn") as refused:
        NearestNeighbour.load(folder)
    assert refused.value.code == "other_parser_version"


def test_an_older_version_that_answers_as_it_did_is_read(folder, monkeypatch):
    monkeypatch.setattr(NearestNeighbour, "version", 3)
    with pytest.raises(Refusal, match=r"\b1 of knn.*\b3 of knn") as refused:
        NearestNeighbour.load(folder)
    assert refused.value.code == "other_parser_version"
    monkeypatch.setattr(NearestNeighbour, "reads", (1, 2))
    assert NearestNeighbour.load(folder).predict(["go"])[0][0].form == '( go " <room> " )'


def test_a_hyperparameter_out_of_bounds_is_refused(folder):
    rewrite(folder / CONFIG, config={"least_overlap": 2})
    with pytest.raises(Refusal, match=r"least_overlap .* 1\b") as refused:
        NearestNeighbour.load(folder)
    assert refused.value.code == "hyperparameter_out_of_range"
