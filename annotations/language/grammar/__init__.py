"""Command grammars: productions read from files, expanded, recognised and checked."""

from __future__ import annotations

from annotations.language.grammar.budget import CHECK_STEPS, Budget, TooManyCombinations
from annotations.language.grammar.derivation_paths import passages
from annotations.language.grammar.expander import Expander, anonymized, intact, readable
from annotations.language.grammar.folder import (
    TEMPLATE_SUFFIX,
    TRIPLE_FILES,
    GrammarFolder,
    apply_alias,
    is_grammar_name,
    is_prose,
    read_grammar_files,
)
from annotations.language.grammar.grammar import ROOT, Grammar
from annotations.language.grammar.graph import MAX_WORDS
from annotations.language.grammar.lattice import Arc, Lattice
from annotations.language.grammar.productions import (
    GrammarFile,
    Production,
    find_heading,
    find_imports,
    print_production,
    read_production,
    read_productions,
    split_comments,
)
from annotations.language.grammar.ranking import (
    Atoms,
    Choices,
    Cursor,
    RankedRule,
    RankedSequence,
    Ranking,
)
from annotations.language.grammar.recognizer import (
    Alternative,
    Chart,
    ChartRule,
    Recognizer,
    RuleBook,
    Run,
    SententialForms,
    WordChart,
    recognizer_of,
)
