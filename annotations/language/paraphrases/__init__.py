"""Paraphrases of prompts: what to tell their writers and moderators, what a language model writes, their vocabulary."""

from __future__ import annotations

from annotations.language.english import KnownWords, folded_words
from annotations.language.paraphrases.misspelt_names import MisspeltNames
from annotations.language.paraphrases.model_replies import rewrites_in
from annotations.language.paraphrases.prompt_entities import entities_in, entities_of
from annotations.language.paraphrases.rewrite_checks import (
    Named,
    RewriteFault,
    RewriteWarning,
    check_rewrite,
    lost_entities,
)
from annotations.language.paraphrases.rewrite_requests import (
    INSTRUCTIONS,
    LONGEST_INSTRUCTIONS,
    check_instructions,
    instructions_version,
    rewrite_request,
)
from annotations.language.paraphrases.submission_flags import (
    Flag,
    FlagCode,
    FreeCommand,
    Rewrite,
    bare_words,
    check_flags,
    free_command_flags,
    rewrite_flags,
)
from annotations.language.paraphrases.vocabulary import expected_vocabulary, vocabulary_growth

__all__ = [
    "INSTRUCTIONS",
    "LONGEST_INSTRUCTIONS",
    "Flag",
    "FlagCode",
    "FreeCommand",
    "KnownWords",
    "MisspeltNames",
    "Named",
    "Rewrite",
    "RewriteFault",
    "RewriteWarning",
    "bare_words",
    "check_flags",
    "check_instructions",
    "check_rewrite",
    "entities_in",
    "entities_of",
    "expected_vocabulary",
    "folded_words",
    "free_command_flags",
    "instructions_version",
    "lost_entities",
    "rewrite_flags",
    "rewrite_request",
    "rewrites_in",
    "vocabulary_growth",
]
