"""The published files, where this machine has them; tests that need them skip where it has not."""

from __future__ import annotations

import os
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
SHARED = Path(os.environ.get("GPSR_SHARED_DATA") or ROOT.parent / "shared" / "data")

needs_corpus = pytest.mark.skipif(
    not (SHARED / "walker2019").is_dir(),
    reason=f"the published corpus is not at {SHARED} (set GPSR_SHARED_DATA)",
)


@cache
def form_lines(*folders: str) -> tuple[str, ...]:
    """The logical forms of the pair files in the folders of the corpus, in order."""
    files = sorted(
        file for name in folders for file in (SHARED / "walker2019" / name).glob("*.txt")
    )
    return tuple(line for file in files for line in file.read_text("utf-8").splitlines()[1::2])
