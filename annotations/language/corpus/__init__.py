"""Read, split and compare pairs of utterances and logical forms."""

from __future__ import annotations

from annotations.language.corpus.distances import distance
from annotations.language.corpus.known import KNOWN, KNOWN_SHARE, harmonic_mean, hold_out_known
from annotations.language.corpus.leakage import (
    MOST_COMPARISONS,
    Leak,
    NearDuplicates,
    comparisons,
    near_duplicates,
    shared,
)
from annotations.language.corpus.pairs import (
    CORPUS_FOLDERS,
    PART_FILES,
    TRIPLES_FILE,
    GroundedTriple,
    Record,
    RecordFile,
    WrittenPair,
    by_length,
    read_pairs,
    read_triples,
    write_pairs,
)
from annotations.language.corpus.shares import draw_share
from annotations.language.corpus.splitting import (
    DEFAULT_PROPORTIONS,
    Criterion,
    FrozenExample,
    Part,
    SplitItem,
    content_hash,
    split,
)

__all__ = [
    "CORPUS_FOLDERS",
    "DEFAULT_PROPORTIONS",
    "KNOWN",
    "KNOWN_SHARE",
    "MOST_COMPARISONS",
    "PART_FILES",
    "TRIPLES_FILE",
    "Criterion",
    "FrozenExample",
    "GroundedTriple",
    "Leak",
    "NearDuplicates",
    "Part",
    "Record",
    "RecordFile",
    "SplitItem",
    "WrittenPair",
    "by_length",
    "comparisons",
    "content_hash",
    "distance",
    "draw_share",
    "harmonic_mean",
    "hold_out_known",
    "near_duplicates",
    "read_pairs",
    "read_triples",
    "shared",
    "split",
    "write_pairs",
]
