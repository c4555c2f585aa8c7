import json

import pytest

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
    with pytest.raises(ValueError, match=r"pairs\.json is not the file that was saved"):
        NearestNeighbour.load(folder)


def test_a_missing_file_is_refused(folder):
    (folder / PAIRS).unlink()
    with pytest.raises(ValueError, match=r"pairs\.json is missing"):
        NearestNeighbour.load(folder)


def test_an_empty_folder_is_refused(tmp_path):
    with pytest.raises(ValueError, match=r"config\.json is missing"):
        NearestNeighbour.load(tmp_path)


@pytest.mark.parametrize("content", [b"\x80\x04\x95", b"not json", b"[]", b"{}"])
def test_a_config_that_describes_no_parser_is_refused(folder, content):
    (folder / CONFIG).write_bytes(content)
    with pytest.raises(ValueError, match=r"config\.json (is not a JSON|does not describe)"):
        NearestNeighbour.load(folder)


def test_another_parser_or_version_is_refused(folder):
    rewrite(folder / CONFIG, version=99)
    with pytest.raises(ValueError, match="holds version 99 of knn, not version 1 of knn"):
        NearestNeighbour.load(folder)


def test_an_older_version_that_answers_as_it_did_is_read(folder, monkeypatch):
    monkeypatch.setattr(NearestNeighbour, "version", 3)
    with pytest.raises(ValueError, match="holds version 1 of knn, not version 3 of knn"):
        NearestNeighbour.load(folder)
    monkeypatch.setattr(NearestNeighbour, "reads", (1, 2))
    assert NearestNeighbour.load(folder).predict(["go"])[0][0].form == '( go " <room> " )'


def test_a_hyperparameter_out_of_bounds_is_refused(folder):
    rewrite(folder / CONFIG, config={"least_overlap": 2})
    with pytest.raises(ValueError, match="at most 1"):
        NearestNeighbour.load(folder)
