"""Rows as a Parquet file, written while it is sent."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from annotations.exchange.pipe import Pipe
from annotations.rows.synchronise import batches

GROUP = 20_000  # rows of a row group, which are in memory at once
METADATA = b"gpsr-workbench"


def parquet_pieces(
    rows: Iterable[Sequence[Any]], fields: Sequence[str], manifest: Mapping[str, Any]
) -> Iterator[bytes]:
    """Yield a Parquet file of ``rows``; its metadata holds ``manifest`` as JSON.

    The fields ``position``, ``id`` and ``version`` are numbers and the others are texts.
    """
    import pyarrow as pa  # takes a second and 60 MB, which nothing else of a web server needs
    import pyarrow.parquet as pq

    types = {"position": pa.int32(), "id": pa.int64(), "version": pa.int64()}
    columns = [pa.field(name, types.get(name, pa.string()), nullable=False) for name in fields]
    written = json.dumps(manifest, ensure_ascii=False).encode()
    schema = pa.schema(columns, metadata={METADATA: written})
    target = Pipe()
    with pq.ParquetWriter(target, schema, compression="zstd") as writer:
        for some in batches(rows, GROUP):
            arrays = [
                pa.array(values, field.type)
                for values, field in zip(zip(*some, strict=True), columns, strict=True)
            ]
            writer.write_batch(pa.record_batch(arrays, schema=schema))
            yield target.take()
    yield target.take()
