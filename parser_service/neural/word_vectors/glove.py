"""GloVe's word vectors (Pennington et al. 2014), read from their published text file."""

from __future__ import annotations

import gzip
import zlib
from collections.abc import Collection, Iterable, Iterator
from math import isfinite
from pathlib import Path

from torch import Tensor, tensor

from annotations.language.texts import Refusal

_GZIP = b"\x1f\x8b"


def read_glove(path: Path, wanted: Collection[str], size: int) -> dict[str, Tensor]:
    """Return the vectors of the ``wanted`` words that the file has.

    Args:
        path: each line is a word and its ``size`` numbers, separated by single spaces; plain or gzipped.
        wanted: other words are skipped while reading, so that memory holds only these.
        size: numbers per vector.

    Returns:
        A vector [size] by word.

    Raises:
        Refusal: a line is malformed (the message says which), or the archive is damaged.
    """
    vectors = {}
    with path.open("rb") as stream:
        is_compressed = stream.read(2) == _GZIP
    with gzip.open(path) if is_compressed else path.open("rb") as lines:
        for number, line in enumerate(_stripped(lines, path), start=1):
            if line.count(b" ") != size:
                raise _malformed_line(
                    path, number, f"has {line.count(b' ')} numbers, not {size}", size
                )
            word, _, numbers = line.partition(b" ")
            text = word.decode("utf-8", errors="replace")
            if text in wanted:
                vectors[text] = tensor(_vector(numbers, path, number, size))  # [size]
    return vectors


def _stripped(lines: Iterable[bytes], path: Path) -> Iterator[bytes]:
    try:
        for line in lines:
            yield line.rstrip(b"\r\n").rstrip(b" ")
    except (EOFError, gzip.BadGzipFile, zlib.error):
        raise Refusal(
            f"{path} is a damaged gzip archive; get GloVe's file again.",
            "pretrained_weights_unreadable",
        ) from None


def _vector(numbers: bytes, path: Path, line: int, size: int) -> list[float]:
    try:
        values = [float(each) for each in numbers.split(b" ")]
    except ValueError:
        values = []
    if not values or not all(map(isfinite, values)):
        raise _malformed_line(path, line, "has something that is not a number", size)
    return values


def _malformed_line(path: Path, line: int, fault: str, size: int) -> Refusal:
    return Refusal(
        f"{path}, line {line}: a line is a word and {size} numbers, but this one {fault}. Get "
        f"GloVe's file again, or set embedding_size to the width of its vectors.",
        "pretrained_weights_unreadable",
    )
