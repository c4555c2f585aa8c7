"""The ontology of a world: its entities, read from and written to the files of the generator."""

from __future__ import annotations

from annotations.language.ontology.additions import Additions, additions_to, read_entities
from annotations.language.ontology.competition_folder import (
    COMPETITION_FILES,
    place_in_folder,
    read_competition,
)
from annotations.language.ontology.entities import Entity, Ontology
from annotations.language.ontology.ontology_checks import ontology_problems
from annotations.language.ontology.ontology_files import (
    ONTOLOGY_FILES,
    read_ontology,
    write_ontology,
)

__all__ = [
    "COMPETITION_FILES",
    "ONTOLOGY_FILES",
    "Additions",
    "Entity",
    "Ontology",
    "additions_to",
    "ontology_problems",
    "place_in_folder",
    "read_competition",
    "read_entities",
    "read_ontology",
    "write_ontology",
]
