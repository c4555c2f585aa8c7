"""Tables as files. Every download of a table is written here, from one pandas frame of rows after another."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from enum import StrEnum
from typing import Any

from annotations.exchange.pipe import Pipe
from annotations.language.texts import require_package
from annotations.rows.synchronise import batches

CHUNK = 2_000  # rows fetched, and sent, at once
GROUP = 10_000  # rows of a row group of Parquet, which are in memory at once
METADATA = b"gpsr-workbench"

# A spreadsheet takes a cell that begins so for a formula.
FORMULA_STARTS = ("=", "+", "-", "@", "\t", "\r")


class TableFormat(StrEnum):
    JSONL = "jsonl"
    CSV = "csv"
    PARQUET = "parquet"


def table_pieces(
    rows: Iterable[Sequence[Any]],
    fields: Sequence[str],
    as_: str,
    types: dict[str, str] | None = None,
    manifest: Mapping[str, Any] | None = None,
) -> Iterator[bytes]:
    """Return a table as a file in pieces, none of them large.

    Args:
        as_: a ``TableFormat``.
        types: of the fields that are no texts in Parquet, as pyarrow calls them.
        manifest: what the metadata of a Parquet file holds as JSON.

    Raises Refusal where Parquet is asked for and pyarrow is not installed.
    """
    match TableFormat(as_):
        case TableFormat.CSV:
            return _csv_pieces(rows, fields)
        case TableFormat.PARQUET:
            require_package("pyarrow", "parquet")
            of_all = dict.fromkeys(fields, "string") | (types or {})
            return _parquet_pieces(rows, of_all, manifest or {})
    encode = json.JSONEncoder(ensure_ascii=False).encode
    return text_pieces(f"{encode(dict(zip(fields, row, strict=True)))}\n" for row in rows)


def text_pieces(lines: Iterable[str]) -> Iterator[bytes]:
    """Return lines of text, each with its line end, as a file in pieces."""
    return ("".join(some).encode() for some in batches(lines, CHUNK))


def formula_safe(cell: Any) -> Any:
    """Return ``cell`` with an apostrophe before anything that a spreadsheet would execute."""
    return f"'{cell}" if isinstance(cell, str) and cell.startswith(FORMULA_STARTS) else cell


def _csv_pieces(rows: Iterable[Sequence[Any]], fields: Sequence[str]) -> Iterator[bytes]:
    yield _frame([], fields).to_csv(index=False, lineterminator="\r\n").encode()
    for some in batches(rows, CHUNK):
        frame = _frame([[formula_safe(cell) for cell in row] for row in some], fields)
        yield frame.to_csv(index=False, header=False, lineterminator="\r\n").encode()


def _parquet_pieces(
    rows: Iterable[Sequence[Any]], types: Mapping[str, str], manifest: Mapping[str, Any]
) -> Iterator[bytes]:
    import pyarrow as pa
    import pyarrow.parquet as pq

    metadata = {METADATA: json.dumps(manifest, ensure_ascii=False).encode()}
    schema = pa.schema(list(types.items()), metadata=metadata)
    target = Pipe()
    with pq.ParquetWriter(target, schema, compression="zstd") as writer:
        for some in batches(rows, GROUP):
            frame = _frame(some, list(types))
            writer.write_table(pa.Table.from_pandas(frame, schema, preserve_index=False))
            yield target.take()
    yield target.take()


def _frame(rows: Sequence[Sequence[Any]], fields: Sequence[str]) -> Any:
    """Return a frame whose cells are what ``rows`` have: no number becomes another one because some are missing."""
    import pandas  # 0.2 s of processor time and 65 MB, which most pages of a web server never need

    return pandas.DataFrame(rows, columns=fields, dtype=object)
