from __future__ import annotations

import csv
import io
import json

import pytest

from annotations.exchange.pair_files import gather_pairs, read_pair_folder
from annotations.exchange.split_export import FIELDS, export_pieces, export_split, pair_lines
from annotations.generation.freezing import freeze_split
from annotations.generation.generating import generate_pairs
from annotations.language.corpus import Criterion
from annotations.language.texts.errors import Refusal
from annotations.models.splits import Source


@pytest.fixture
def split(tiny_world):
    generate_pairs(tiny_world)
    return freeze_split(tiny_world, "first")


def written(split, as_: str) -> str:
    return b"".join(export_pieces(split, as_)).decode()


def test_a_pair_file_needs_a_part_and_a_source(split):
    with pytest.raises(Refusal) as refused:
        pair_lines(split, "train", None)
    assert refused.value.code == "part_and_source_needed"


def test_every_format_gives_every_example_in_one_query(split, django_assert_num_queries):
    with django_assert_num_queries(1):
        rows = [json.loads(line) for line in written(split, "jsonl").splitlines()]
    with django_assert_num_queries(1):
        cells = list(csv.DictReader(io.StringIO(written(split, "csv"))))
    assert len(rows) == len(cells) == 3
    assert list(rows[0]) == list(cells[0]) == FIELDS
    assert [row["utterance"] for row in rows] == [row["utterance"] for row in cells]


def test_pandas_reads_tables_as_they_are(split):
    import pandas

    rows = list(split.examples.values(*FIELDS))
    files = {as_: io.BytesIO(b"".join(export_pieces(split, as_))) for as_ in ("parquet", "csv")}
    assert pandas.read_parquet(files["parquet"]).to_dict("records") == rows
    table = pandas.read_csv(files["csv"], dtype={"task_category": str}, keep_default_na=False)
    assert table.to_dict("records") == rows


@pytest.mark.parametrize("start", ["=", "+", "-", "@", "\t", "\r"])
def test_no_cell_is_a_formula(split, start):
    split.examples.update(utterance=f"{start}cmd|' /C calc'!A0")
    for row in csv.DictReader(io.StringIO(written(split, "csv"), newline="")):
        assert row["utterance"].startswith(f"'{start}")


@pytest.mark.parametrize(
    ("criterion", "folder"),
    [
        ("command", "gen"),
        ("logical_form", "gen_logical"),
        ("source_command", "gen_source_command"),
    ],
)
def test_a_whole_split_is_a_folder_by_criterion(tiny_world, tmp_path, criterion, folder):
    generate_pairs(tiny_world)
    split = freeze_split(tiny_world, "whole", criterion, proportions=(1, 0, 0))
    assert export_split(split, "txt", tmp_path) == {str(tmp_path / folder / "train.txt"): 3}


def test_other_formats_are_one_file(split, tmp_path):
    target = tmp_path / "deep" / "first.jsonl"
    assert export_split(split, "jsonl", target) == {str(target): 3}
    assert len(target.read_text().splitlines()) == 3


@pytest.mark.parametrize("source", Source.values)
@pytest.mark.parametrize("criterion", [Criterion.COMMAND, Criterion.LOGICAL_FORM])
def test_pair_files_of_every_source_are_read_as_its_own(tiny_world, tmp_path, source, criterion):
    generate_pairs(tiny_world)
    split = freeze_split(tiny_world, "whole", criterion, proportions=(1, 0, 0))
    split.examples.update(source=source)
    export_split(split, "txt", tmp_path)
    read = read_pair_folder(gather_pairs(tmp_path))
    assert {key: len(pairs) for key, pairs in read.pairs.items()} == {
        (criterion, source, "train"): 3
    }
