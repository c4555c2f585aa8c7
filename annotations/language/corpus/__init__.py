"""Read, split and compare pairs of utterances and logical forms."""

from __future__ import annotations

from annotations.language.corpus.crowd import is_crowd_file, read_crowd_results
from annotations.language.corpus.distances import distance
from annotations.language.corpus.foreign_pairs import foreign_part, read_foreign_pairs
from annotations.language.corpus.leakage import (
    MOST_COMPARISONS,
    Leak,
    NearDuplicates,
    comparisons,
    near_duplicates,
    shared,
)
from annotations.language.corpus.splitting import (
    DEFAULT_PROPORTIONS,
    KNOWN,
    KNOWN_SHARE,
    Criterion,
    FrozenExample,
    Part,
    SplitItem,
    content_hash,
    draw_share,
    harmonic_mean,
    hold_out_known,
    split,
)
from annotations.language.corpus.written_pairs import (
    CORPUS_FOLDERS,
    PART_FILES,
    PARTS,
    TRIPLES_FILE,
    GroundedTriple,
    Record,
    RecordFile,
    WrittenPair,
    by_length,
    is_corpus_path,
    read_pairs,
    read_triples,
    write_pairs,
)

__all__ = [
    "CORPUS_FOLDERS",
    "DEFAULT_PROPORTIONS",
    "KNOWN",
    "KNOWN_SHARE",
    "MOST_COMPARISONS",
    "PARTS",
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
    "foreign_part",
    "harmonic_mean",
    "hold_out_known",
    "is_corpus_path",
    "is_crowd_file",
    "near_duplicates",
    "read_crowd_results",
    "read_foreign_pairs",
    "read_pairs",
    "read_triples",
    "shared",
    "split",
    "write_pairs",
]
