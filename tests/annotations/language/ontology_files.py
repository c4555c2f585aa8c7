"""Ontologies of tests, read from folders."""

from __future__ import annotations

from pathlib import Path

from annotations.language.texts.errors import Problem
from annotations.language.world import ONTOLOGY_FILES, Ontology, read_ontology


def read_ontology_folder(folder: Path) -> tuple[Ontology, tuple[Problem, ...]]:
    """Read the ontology files that the folder has; see ``read_ontology``."""
    files = {name: folder / name for name in ONTOLOGY_FILES if (folder / name).is_file()}
    return read_ontology({name: path.read_bytes() for name, path in files.items()})
