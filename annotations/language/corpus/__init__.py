"""Pairs of utterances and forms: splits, distances, paraphrases, agreement, labels in doubt."""

from __future__ import annotations

from annotations.language.corpus.agreement import Agreement, Distances, measure
from annotations.language.corpus.crowd import (
    Assignment,
    CrowdRewrite,
    CrowdTable,
    read_crowd_results,
)
from annotations.language.corpus.distances import distance, words
from annotations.language.corpus.foreign_pairs import foreign_part, read_foreign_pairs
from annotations.language.corpus.label_errors import (
    LEAST_FOLDS,
    MOST_FOLDS,
    LabelledPair,
    Reason,
    ScoredForm,
    Suspect,
    assign_folds,
    check_answers,
    check_commands,
    check_words,
    rank,
    source_key,
)
from annotations.language.corpus.leakage import (
    MOST_COMPARISONS,
    Leak,
    NearDuplicates,
    comparisons,
    near_duplicates,
    shared,
)
from annotations.language.corpus.misspelt_names import MisspeltNames
from annotations.language.corpus.model_replies import rewrites_in
from annotations.language.corpus.names import (
    CLASS_OF_ATTRIBUTE,
    EntityName,
    rename_in_attributes,
    rename_in_conditions,
    rename_in_grounded_form,
    rename_in_template,
    rename_in_utterance,
    rename_nonterminal_in_form,
    rename_nonterminal_in_pattern,
    rename_predicate,
    require_entity_name,
    require_nonterminal,
    require_predicate,
)
from annotations.language.corpus.overlap import FormOverlap, Overlap, overlap_of, together
from annotations.language.corpus.prompt_entities import entities_in, entities_of
from annotations.language.corpus.proportions import Z_95, wilson_interval, wilson_intervals
from annotations.language.corpus.rewording import Rewording
from annotations.language.corpus.rewrite_checks import (
    Named,
    RewriteFault,
    RewriteWarning,
    check_rewrite,
    lost_entities,
)
from annotations.language.corpus.rewrite_requests import (
    INSTRUCTIONS,
    LONGEST_INSTRUCTIONS,
    check_instructions,
    instructions_version,
    rewrite_request,
)
from annotations.language.corpus.splitting import (
    DEFAULT_PROPORTIONS,
    KNOWN,
    KNOWN_SHARE,
    Criterion,
    FrozenExample,
    Part,
    SplitItem,
    content_hash,
    draw_share,
    harmonic_mean,
    hold_out_known,
    split,
)
from annotations.language.corpus.submission_flags import (
    Flag,
    FlagCode,
    FreeCommand,
    Rewrite,
    bare_words,
    check_flags,
    free_command_flags,
    rewrite_flags,
)
from annotations.language.corpus.vocabulary import expected_vocabulary, vocabulary_growth
from annotations.language.corpus.written_pairs import (
    CORPUS_FOLDERS,
    PART_FILES,
    PARTS,
    TRIPLES_FILE,
    GroundedTriple,
    Record,
    RecordFile,
    WrittenPair,
    by_length,
    is_corpus_path,
    read_pairs,
    read_triples,
    write_pairs,
    write_triples,
)
