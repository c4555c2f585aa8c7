"""English word lists, patterns and plurals: data kept apart from code."""

from __future__ import annotations

from annotations.language.english.contrasts import (
    CONTRASTS,
    NEAR_SYNONYMS,
    NEGATIONS,
    PREDICATE_WORDS,
)
from annotations.language.english.function_words import (
    ARTICLES,
    NO_COMMAND_WORDS,
    POLITE_OPENINGS,
    RECIPIENT_PRONOUNS,
)
from annotations.language.english.glosses import (
    CLASS_WORDS,
    KNOWN_PATTERNS,
    NUMBERS,
    PREPOSITIONS,
    RELATIONS,
)
from annotations.language.english.inflection import plural, say_count, spellings
from annotations.language.english.sample_commands import (
    BOUNDARIES,
    DETERMINERS,
    GOING_WORDS,
    PERSON_WORDS,
    SAMPLE_COMMANDS,
    THING_WORDS,
)
from annotations.language.english.unrelated_sentences import UNRELATED_SENTENCES

__all__ = [
    "ARTICLES",
    "BOUNDARIES",
    "CLASS_WORDS",
    "CONTRASTS",
    "DETERMINERS",
    "GOING_WORDS",
    "KNOWN_PATTERNS",
    "NEAR_SYNONYMS",
    "NEGATIONS",
    "NO_COMMAND_WORDS",
    "NUMBERS",
    "PERSON_WORDS",
    "POLITE_OPENINGS",
    "PREDICATE_WORDS",
    "PREPOSITIONS",
    "RECIPIENT_PRONOUNS",
    "RELATIONS",
    "SAMPLE_COMMANDS",
    "THING_WORDS",
    "UNRELATED_SENTENCES",
    "plural",
    "say_count",
    "spellings",
]
