"""Published pairs as parsers read them, without a database."""

from pathlib import Path

from parser_service.parsers.interface import Pair


def read_pairs(path: Path) -> list[Pair]:
    """The pairs of a file of alternating lines."""
    lines = path.read_text(encoding="utf-8").splitlines()
    source = "generated" if path.parent.name.startswith("gen") else "paraphrased"
    return [Pair(*both, source) for both in zip(lines[::2], lines[1::2], strict=True)]
