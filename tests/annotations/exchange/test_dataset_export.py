"""A split as a data set of Hugging Face, read by the library itself."""

from __future__ import annotations

import io
import zipfile

import pytest
import yaml

from annotations.exchange.dataset_card import COLUMNS
from annotations.exchange.split_export import FIELDS, export_pieces, export_split
from annotations.generation.freezing import freeze_split
from annotations.generation.generating import generate_pairs
from annotations.models import Split

datasets = pytest.importorskip("datasets", reason="needs the package datasets")


@pytest.fixture
def split(tiny_world) -> Split:
    generate_pairs(tiny_world)
    return freeze_split(tiny_world, "first", proportions=(0.5, 0, 0.5))


@pytest.fixture
def read(tmp_path):
    """A function: the data set in a folder."""

    def load(folder):
        return datasets.load_dataset(str(folder), cache_dir=str(tmp_path / "cache"))

    return load


def test_the_library_reads_the_parts_of_a_folder(split, tmp_path, read):
    files = export_split(split, "datasets", tmp_path / "first")
    parts = read(tmp_path / "first")
    assert {part: len(rows) for part, rows in parts.items()} == {"train": 2, "test": 1}
    assert files == {
        str(tmp_path / "first" / "data" / f"{part}.parquet"): len(rows)
        for part, rows in parts.items()
    }
    for part, rows in parts.items():
        assert list(rows) == list(split.examples.filter(part=part).values(*FIELDS))


def test_an_archive_of_one_part_holds_it_alone(split, tmp_path, read):
    content = io.BytesIO(b"".join(export_pieces(split, "datasets", part="test")))
    zipfile.ZipFile(content).extractall(tmp_path / "first")
    assert {part: len(rows) for part, rows in read(tmp_path / "first").items()} == {"test": 1}


def test_the_card_names_the_parts_the_columns_and_the_hash(split):
    archive = zipfile.ZipFile(io.BytesIO(b"".join(export_pieces(split, "datasets"))))
    card = archive.read("README.md").decode()
    header = yaml.safe_load(card.split("---\n")[1])
    (config,) = header["configs"]
    paths = [each["path"] for each in config["data_files"]]
    assert sorted(archive.namelist()) == sorted(["README.md", *paths])
    assert list(COLUMNS) == FIELDS
    assert split.content_hash in card
    assert "| generated | 2 | 1 |" in card


def test_it_is_downloaded_as_an_archive(split, call_as, annotator):
    answer = call_as(annotator, "get", f"worlds/home/splits/{split.pk}/export/?as=datasets")
    names = zipfile.ZipFile(io.BytesIO(b"".join(answer.streaming_content))).namelist()
    assert (answer["Content-Type"], names[0]) == ("application/zip", "README.md")
    assert answer["Content-Disposition"].endswith('.datasets.zip"')
