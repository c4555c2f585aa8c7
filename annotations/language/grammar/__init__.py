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
    print_production,
    read_production,
    read_productions,
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
    Item,
    Recognizer,
    RuleBook,
    Run,
)

__all__ = [
    "CHECK_STEPS",
    "MAX_WORDS",
    "ROOT",
    "TEMPLATE_SUFFIX",
    "TRIPLE_FILES",
    "Alternative",
    "Arc",
    "Atoms",
    "Budget",
    "Chart",
    "ChartRule",
    "Choices",
    "Cursor",
    "Expander",
    "Grammar",
    "GrammarFile",
    "GrammarFolder",
    "Item",
    "Lattice",
    "Production",
    "RankedRule",
    "RankedSequence",
    "Ranking",
    "Recognizer",
    "RuleBook",
    "Run",
    "TooManyCombinations",
    "anonymized",
    "apply_alias",
    "intact",
    "is_grammar_name",
    "is_prose",
    "passages",
    "print_production",
    "read_grammar_files",
    "read_production",
    "read_productions",
    "readable",
]
