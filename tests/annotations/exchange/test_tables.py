"""What a table is written as, pandas reads back equal."""

from __future__ import annotations

import io
import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from annotations.exchange import tables
from annotations.exchange.tables import METADATA, formula_safe, table_pieces

TYPES = {"id": "int64", "score": "double", "is_right": "bool"}
FIELDS = ["id", "text", "score", "is_right"]
TEXTS = st.text(st.characters(codec="utf-8", exclude_characters="\0"))
VALUES = st.tuples(
    st.integers(-(2**63), 2**63 - 1),
    TEXTS,
    st.none() | st.floats(allow_nan=False),
    st.none() | st.booleans(),
)
ROWS = st.lists(VALUES)


@pytest.fixture(autouse=True, scope="module")
def small_pieces():
    """Rows in pieces of two, so that a short table has several."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(tables, "CHUNK", 2)
        patch.setattr(tables, "GROUP", 2)
        yield


def written(rows: list[tuple[object, ...]], as_: str) -> io.BytesIO:
    return io.BytesIO(b"".join(table_pieces(rows, FIELDS, as_, TYPES, {"version": 1})))


@given(rows=ROWS)
def test_csv_is_read_by_pandas(rows):
    import pandas

    frame = pandas.read_csv(written(rows, "csv"), dtype=str, keep_default_na=False)
    assert list(frame) == FIELDS
    assert frame.to_numpy().tolist() == [
        ["" if value is None else str(formula_safe(value)) for value in row] for row in rows
    ]


@given(rows=ROWS)
def test_parquet_is_read_by_pandas(rows):
    import pandas
    import pyarrow.parquet as pq

    file = written(rows, "parquet")
    frame = pandas.read_parquet(file).astype(object)
    cells = frame.where(frame.notna(), None)
    assert list(cells.itertuples(index=False, name=None)) == rows
    schema = pq.read_schema(file)
    assert [str(field.type) for field in schema] == ["int64", "string", "double", "bool"]
    assert json.loads(schema.metadata[METADATA]) == {"version": 1}


@given(rows=ROWS)
def test_json_lines_are_read_line_by_line(rows):
    lines = written(rows, "jsonl").getvalue().decode().split("\n")
    assert [tuple(json.loads(line).values()) for line in lines[:-1]] == rows


def test_a_large_table_comes_in_pieces():
    rows = ((number, "", None, None) for number in range(5))
    pieces = table_pieces(rows, FIELDS, "csv", TYPES)
    assert next(pieces) == b"id,text,score,is_right\r\n"
    assert next(pieces) == b"0,,,\r\n1,,,\r\n"
    assert next(rows)[0] == 2
