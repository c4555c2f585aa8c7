"""The ontology of a world: its values, read from and written to the files of the generator."""

from __future__ import annotations

from annotations.language.entities import Entity, Ontology
from annotations.language.ontology_checks import ontology_problems
from annotations.language.ontology_reading import (
    ONTOLOGY_FILES,
    read_ontology,
    read_ontology_folder,
)
from annotations.language.ontology_writing import write_ontology

__all__ = [
    "ONTOLOGY_FILES",
    "Entity",
    "Ontology",
    "ontology_problems",
    "read_ontology",
    "read_ontology_folder",
    "write_ontology",
]
