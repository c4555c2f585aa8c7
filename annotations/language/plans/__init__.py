"""What a robot does: requests, plans, recipes and joint plans, and the dialogue that closes what is open."""

from __future__ import annotations

from annotations.language.plans.alternatives import best_alternative
from annotations.language.plans.applying import apply_recipes
from annotations.language.plans.behavior_tree import TAKEN_NAMES, Robust, to_behavior_tree
from annotations.language.plans.book import (
    DEFAULT_BOOK,
    RecipeBook,
    ShippedBook,
    default_book,
    read_book,
    shipped_books,
)
from annotations.language.plans.comparing import plan_key, same_plan
from annotations.language.plans.cutting import (
    Islands,
    Judge,
    Piece,
    cut,
    cut_at_joints,
    last_clause,
    sentences,
    without_clause,
)
from annotations.language.plans.fitting import (
    Exchange,
    Fit,
    Left,
    LeftOut,
    best_fitting,
    exchange,
    fit,
)
from annotations.language.plans.habitual_places import UsualPlaces, usual_places
from annotations.language.plans.joint_plans import (
    METRES,
    MOST_COMMANDS,
    Distances,
    JointPlan,
    NoteKind,
    Reason,
    TooManyCommands,
    WrongDistance,
    join,
    joint_plan_schema,
    joint_plan_schema_text,
    say_length,
)
from annotations.language.plans.lookup import Lookup
from annotations.language.plans.machine import (
    ATTEMPTS,
    PATIENCE,
    DialogueManager,
    DialogueState,
    Offer,
    Phase,
    progress,
    shall_i,
)
from annotations.language.plans.plan import (
    ASK,
    ActionName,
    Described,
    Named,
    Number,
    Operator,
    Plan,
    Referred,
    StepResult,
    TaskValue,
    Trouble,
    Value,
    Words,
    behavior_tree_schema_text,
    plan_schema,
    plan_schema_text,
)
from annotations.language.plans.planning import make_plan
from annotations.language.plans.proposing import arguments_by_action, propose, with_proposals
from annotations.language.plans.qualifying import Objection, is_qualified, objections, says_number
from annotations.language.plans.reactions import Reaction, reaction_of
from annotations.language.plans.reading import read_primitive, read_recipe
from annotations.language.plans.request_kinds import other_requests
from annotations.language.plans.rows import (
    AFTER_COMMANDS,
    ActionPattern,
    EffectKind,
    Primitive,
    Recipe,
)
from annotations.language.plans.speaking import spoken
from annotations.language.plans.stopping import NearCommands, StoppingWords, with_entities
from annotations.language.plans.task_plan import (
    RecipeTrouble,
    TaskPlan,
    TaskStep,
    task_plan_schema,
    task_plan_schema_text,
)
from annotations.language.plans.unresolved import COMMAND, said_words
from annotations.language.plans.word_use import WordUse
