"""Edit utterances by a word: pairs that a corpus has, and edits made so that the right form is known."""

from __future__ import annotations

from parser_service.analysis.edits.all_edits import generate_edits
from parser_service.analysis.edits.edit import EditKind
from parser_service.analysis.edits.facts import WorldFacts, gather_facts
from parser_service.analysis.edits.mining import mine_pairs, words_of

__all__ = [
    "EditKind",
    "WorldFacts",
    "gather_facts",
    "generate_edits",
    "mine_pairs",
    "words_of",
]
