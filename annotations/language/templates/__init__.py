"""Semantic templates: read and check them, expand them with a grammar, help people who write them."""

from __future__ import annotations

from annotations.language.templates.analogy import solve as solve_analogy
from annotations.language.templates.bounded_cache import BoundedCache
from annotations.language.templates.chart import ChartDerivation, TemplateChart
from annotations.language.templates.completion import completions
from annotations.language.templates.composition import SynchronousGrammar
from annotations.language.templates.consequences import (
    Consequences,
    GeneratedState,
    consequences_of,
)
from annotations.language.templates.expansion import (
    Expansion,
    Generated,
    TaskCategory,
    generate,
    generation_size,
)
from annotations.language.templates.generator_folder import (
    Composition,
    GeneratorFolder,
    is_template_name,
    read_generator_files,
    read_generator_folder,
)
from annotations.language.templates.grammar_expansions import DEFAULT_LIMIT, GrammarExpansions
from annotations.language.templates.left_out import Usage, usage_of
from annotations.language.templates.patterns import PatternMaker, nearest_patterns
from annotations.language.templates.ranked_templates import RankedGrammar, RankedTemplate
from annotations.language.templates.repairs import with_repairs
from annotations.language.templates.sample_notes import (
    EVERYTHING,
    LARGEST_SEED,
    MOST_COUNTED,
    MOST_SAMPLED,
    Balance,
    SampleNote,
    SampleRequest,
)
from annotations.language.templates.sampling import Language
from annotations.language.templates.sides import (
    correspondences,
    format_form,
    format_pattern,
    read_known_sides,
)
from annotations.language.templates.spreading import spread_derivations
from annotations.language.templates.suggester import (
    MOST_SUGGESTIONS,
    SURE_SHARE,
    FormSuggester,
    Suggestion,
)
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
    read_templates,
)
from annotations.language.templates.transfer import lift_forms, transfer_form
from annotations.language.templates.trial import Sides
