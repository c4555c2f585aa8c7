"""The ontology of a world: its entities, read from and written to the files of the generator."""

from __future__ import annotations

from annotations.language.ontology.additions import Additions, additions_to, read_entities
from annotations.language.ontology.competition_folder import (
    COMPETITION_CLASSES,
    COMPETITION_FILES,
    choose_files,
    guess_room,
    may_be_in_folder,
    read_competition,
)
from annotations.language.ontology.entities import Entity, Ontology
from annotations.language.ontology.ontology_checks import ontology_problems
from annotations.language.ontology.ontology_files import (
    CLASSES_FILE,
    ONTOLOGY_FILES,
    read_ontology,
    write_ontology,
)
from annotations.language.ontology.published_generators import (
    PUBLISHED_GENERATORS,
    lost_rows,
    warnings_of_lost,
)

__all__ = [
    "CLASSES_FILE",
    "COMPETITION_CLASSES",
    "COMPETITION_FILES",
    "ONTOLOGY_FILES",
    "PUBLISHED_GENERATORS",
    "Additions",
    "Entity",
    "Ontology",
    "additions_to",
    "choose_files",
    "guess_room",
    "lost_rows",
    "may_be_in_folder",
    "ontology_problems",
    "read_competition",
    "read_entities",
    "read_ontology",
    "warnings_of_lost",
    "write_ontology",
]
