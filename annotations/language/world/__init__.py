"""What a world is made of: its entities, and the predicates that its forms use."""

from __future__ import annotations

from annotations.language.world.additions import Additions, additions_to, read_entities
from annotations.language.world.competition_folder import (
    COMPETITION_CLASSES,
    COMPETITION_FILES,
    choose_files,
    guess_room,
    may_be_in_folder,
    read_competition,
)
from annotations.language.world.entities import Entity, Ontology
from annotations.language.world.gloss_patterns import SUPERLATIVES, pattern_of_name, read_pattern
from annotations.language.world.glossing import NAMING
from annotations.language.world.ontology_checks import ontology_problems
from annotations.language.world.ontology_files import (
    CLASSES_FILE,
    ENTITIES_FILE,
    ONTOLOGY_FILES,
    read_ontology,
    write_ontology,
)
from annotations.language.world.predicates import (
    Misuse,
    Predicate,
    PredicateKind,
    ask_for,
    check_form,
    declared_or_inferred,
    find_misuses,
    gloss,
    infer_signatures,
    said_of,
    sample_forms,
    sample_use,
)
from annotations.language.world.published_generators import (
    PUBLISHED_GENERATORS,
    lost_rows,
    warnings_of_lost,
)
from annotations.language.world.signatures import (
    ArgumentKind,
    Signature,
    admits,
    argument_kind,
    is_entity_kind,
    known_kinds,
    print_signatures,
    read_signatures,
    signature_of,
)
from annotations.language.world.standing_in import can_stand_in, is_loose, texts_of_patterns
