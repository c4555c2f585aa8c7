"""Read and check semantic templates, and expand them with a grammar into commands and forms."""

from __future__ import annotations

from annotations.language.templates.bounded_cache import BoundedCache
from annotations.language.templates.chart import ChartDerivation, TemplateChart
from annotations.language.templates.composition import SynchronousGrammar
from annotations.language.templates.consequences import (
    Consequences,
    GeneratedState,
    consequences_of,
)
from annotations.language.templates.expansion import (
    Conflict,
    Expansion,
    Generated,
    TaskCategory,
    generate,
    generation_size,
)
from annotations.language.templates.filling import bare, fill_anonymized
from annotations.language.templates.generator_folder import (
    Composition,
    GeneratorFolder,
    is_template_name,
    read_generator_files,
    read_generator_folder,
)
from annotations.language.templates.grammar_expansions import DEFAULT_LIMIT, GrammarExpansions
from annotations.language.templates.ranked_templates import RankedGrammar, RankedTemplate
from annotations.language.templates.sample_notes import (
    EVERYTHING,
    LARGEST_SEED,
    MOST_COUNTED,
    MOST_SAMPLED,
    Balance,
    SampleNote,
    SampleRequest,
)
from annotations.language.templates.sampling import Language, Sample
from annotations.language.templates.spreading import spread_derivations
from annotations.language.templates.synchronous import Derivation, TemplateExpander
from annotations.language.templates.template_checks import (
    TemplateChecker,
    set_problems,
    shared_problems,
    template_checker,
)
from annotations.language.templates.templates import (
    SemanticTemplate,
    make_template,
    print_template,
    read_sides,
    read_template,
)

__all__ = [
    "DEFAULT_LIMIT",
    "EVERYTHING",
    "LARGEST_SEED",
    "MOST_COUNTED",
    "MOST_SAMPLED",
    "Balance",
    "BoundedCache",
    "ChartDerivation",
    "Composition",
    "Conflict",
    "Consequences",
    "Derivation",
    "Expansion",
    "Generated",
    "GeneratedState",
    "GeneratorFolder",
    "GrammarExpansions",
    "Language",
    "RankedGrammar",
    "RankedTemplate",
    "Sample",
    "SampleNote",
    "SampleRequest",
    "SemanticTemplate",
    "SynchronousGrammar",
    "TaskCategory",
    "TemplateChart",
    "TemplateChecker",
    "TemplateExpander",
    "bare",
    "consequences_of",
    "fill_anonymized",
    "generate",
    "generation_size",
    "is_template_name",
    "make_template",
    "print_template",
    "read_generator_files",
    "read_generator_folder",
    "read_sides",
    "read_template",
    "set_problems",
    "shared_problems",
    "spread_derivations",
    "template_checker",
]
